//! Drives over the field in good and in bad light, and prints what each frame shows: `cargo run --example 04_photograph_the_field [SEED]`.

use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_scene_sim::SimulationError;
use wayfix_scene_sim::league::{COLOR_NAMES, LampSetting, LeagueDrive, LeagueParams, LeaguePicture};
use wayfix_scene_sim::random::RandomStreams;
use wayfix_sensor_log::EncodedImage;

/// How many pixels show a colour, and their mean red, green and blue.
fn summary(picture: &LeaguePicture, color: usize) -> Option<(usize, [usize; 3])> {
    let pixels = picture.rgb.chunks_exact(3).zip(&picture.labels);
    let shown: Vec<&[u8]> =
        pixels.filter(|(_, label)| usize::from(**label) == color + 1).map(|(rgb, _)| rgb).collect();
    let mean =
        |channel: usize| shown.iter().map(|rgb| usize::from(rgb[channel])).sum::<usize>() / shown.len();
    (!shown.is_empty()).then(|| (shown.len(), [0, 1, 2].map(mean)))
}

fn main() -> Result<(), SimulationError> {
    let seed = std::env::args().nth(1).and_then(|seed| seed.parse().ok()).unwrap_or(1);
    let lights = vec![(0, LampSetting::Bright), (4, LampSetting::Dark)];
    let params =
        LeagueParams { n_frames: 8, period_ms: 1000, lamp_settings: lights, ..LeagueParams::default() };
    let drive = LeagueDrive::new(&params, RandomStreams::new(ChaCha8Rng::seed_from_u64(seed)))?;
    let quality = drive.venue().camera.jpeg_quality;
    for frame in drive {
        let LeaguePicture { width, height, rgb, .. } = &frame.picture;
        let png = EncodedImage::png_rgb(*width, *height, rgb)?;
        let jpeg = EncodedImage::jpeg(*width, *height, rgb, quality)?;
        print!(
            "{:5} ms  {:6?}  PNG {:5} JPEG {:5} bytes ",
            frame.milliseconds,
            frame.lighting,
            png.bytes.len(),
            jpeg.bytes.len()
        );
        for (color, name) in COLOR_NAMES.iter().enumerate() {
            if let Some((n_pixels, mean)) = summary(&frame.picture, color) {
                print!("  {name} {n_pixels} {mean:?}");
            }
        }
        println!();
    }
    Ok(())
}
