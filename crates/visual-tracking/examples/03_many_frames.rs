//! Shows a film over and over to a tracker and prints how much memory it takes meanwhile.
//!
//! `cargo run --release -p wayfix-visual-tracking --example 06_many_frames -- contour|box N_FRAMES`; the film is shown at a quarter of its size. The
//! memory is the highest of the process so far (Linux).

use std::error::Error;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_scene_sim::film::{FilmFrame, SyntheticFilm};
use wayfix_visual_tracking::{
    BoundingBox, ColorContourTracker, CorrelationTracker, PixelMask, RgbImage, TrackStatus, Tracker,
};

/// Every so many pixels are taken.
const STRIDE: usize = 4;
const SIZE: (usize, usize) = (SyntheticFilm::SIZE_PX.0 / STRIDE, SyntheticFilm::SIZE_PX.1 / STRIDE);

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (method, n_frames) = (arguments.next(), arguments.next());
    let n_frames: usize = n_frames.ok_or("contour or box, and a number of frames")?.parse()?;
    let frames: Vec<FilmFrame> = SyntheticFilm::named("snail")?.frames()?.collect();
    let pictures: Vec<RgbImage> = frames.iter().map(shrunk).collect::<Result<_, _>>()?;
    let target = &frames[0].target;
    let mask = PixelMask::from_fn(SIZE.0, SIZE.1, |u, v| target.pixels()[STRIDE * (v * target.width() + u)])?;
    match method.as_deref() {
        Some("contour") => watch(
            &mut ColorContourTracker::from_mask(&pictures[0], &mask, Default::default())?,
            &pictures,
            n_frames,
        ),
        Some("box") => {
            let [x, y, w, h] = target.bounding_box().ok_or("no target")?.map(|x| x / STRIDE as f64);
            let start = BoundingBox::from_corner(x, y, w, h)?;
            watch(&mut CorrelationTracker::new(&pictures[0], start, Default::default())?, &pictures, n_frames)
        }
        _ => Err("contour or box".into()),
    }
}

/// There and back again, so that nothing jumps.
fn watch(tracker: &mut impl Tracker, pictures: &[RgbImage], n_frames: usize) -> Result<(), Box<dyn Error>> {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let there_and_back = (0..pictures.len()).chain((1..pictures.len() - 1).rev()).cycle();
    let mut n_lost = 0;
    for (n, k) in (1..=n_frames).zip(there_and_back) {
        n_lost += usize::from(tracker.track(&pictures[k], &mut rng)?.status == TrackStatus::Lost);
        if n == 1000 || n % 10_000 == 0 || n == n_frames {
            println!("{n} frames, {n_lost} lost, {} kB", peak_kilobytes()?);
        }
    }
    Ok(())
}

fn shrunk(frame: &FilmFrame) -> Result<RgbImage, Box<dyn Error>> {
    let (picture, n) = (&frame.picture, SIZE.0 * SIZE.1);
    let first = |i: usize| 3 * (i / SIZE.0 * STRIDE * picture.width + i % SIZE.0 * STRIDE);
    let bytes = (0..n).flat_map(|i| picture.rgb[first(i)..first(i) + 3].iter().copied()).collect();
    Ok(RgbImage::from_raw(SIZE.0 as u32, SIZE.1 as u32, bytes).expect("3 bytes a pixel"))
}

fn peak_kilobytes() -> Result<u64, Box<dyn Error>> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:")).ok_or("no peak in the status")?;
    Ok(line.split_whitespace().nth(1).ok_or("no number")?.parse()?)
}
