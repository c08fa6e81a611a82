//! `cargo run --example 06_render_a_film -- beetle FOLDER [SEED]`: the frames of a film as PNG files and the true boxes as `truth.txt`, ready for
//! `wayfix run track --frames FOLDER --truth FOLDER/truth.txt`.

use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

use wayfix_scene_sim::film::SyntheticFilm;
use wayfix_sensor_log::EncodedImage;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut film = SyntheticFilm::named(&arguments.next().ok_or("which film?")?)?;
    let folder = PathBuf::from(arguments.next().ok_or("into which folder?")?);
    if let Some(seed) = arguments.next() {
        film.seed = seed.parse()?;
    }
    fs::create_dir_all(&folder)?;
    let mut truth = String::new();
    for (index, frame) in film.frames()?.enumerate() {
        let picture = &frame.picture;
        let png = EncodedImage::png_rgb(picture.width as u32, picture.height as u32, &picture.rgb)?;
        fs::write(folder.join(format!("{index:04}.png")), &png.bytes)?;
        let [x, y, width, height] = frame.target.bounding_box().unwrap_or([0.0; 4]);
        writeln!(truth, "{x},{y},{width},{height}")?;
    }
    fs::write(folder.join("truth.txt"), truth)?;
    Ok(())
}
