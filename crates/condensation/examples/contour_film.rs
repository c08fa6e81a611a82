//! How well the contour tracker follows simulated targets: `cargo run --release --example contour_film -- [FILM] [SEEDS]`.
//!
//! Overlap (intersection over union) with the true mask, for the full method and without one of its parts.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_condensation::{
    BitMask, BoundingBox, ContourTracker, ContourTrackerParams, Picture, Target, TrackStatus, Tracker,
    TrackingCues,
};
use wayfix_scene_sim::film::{Film, Frame, Incident, Silhouette};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let only = arguments.first().map(String::as_str).filter(|name| *name != "all");
    let n_seeds = arguments.get(1).map_or(Ok(3), |n| n.parse())?;
    let method = arguments.get(2).map(String::as_str);
    let incident = match std::env::var("INCIDENT").as_deref() {
        Ok("partly") => Incident::PartlyHidden,
        Ok("hidden") => Incident::Hidden,
        Ok("away") => Incident::Away,
        _ => Incident::None,
    };
    let full = ContourTrackerParams::default();
    let methods = [
        ("full", full),
        ("fixed colours", ContourTrackerParams { adapts: false, ..full }),
        ("colour only", ContourTrackerParams { cues: TrackingCues::Color, ..full }),
        ("shape only", ContourTrackerParams { cues: TrackingCues::Shape, ..full }),
    ];
    for film in Film::ALL.into_iter().filter(|film| only.is_none_or(|only| only == film.name)) {
        for (name, params) in methods.iter().filter(|(name, _)| method.is_none_or(|method| method == *name)) {
            let runs: Vec<Run> = (1..=n_seeds)
                .map(|seed| follow(&Film { seed, incident, ..film }, params))
                .collect::<Result<_, _>>()?;
            let mean = |value: fn(&Run) -> f64| runs.iter().map(value).sum::<f64>() / runs.len() as f64;
            let worst = runs.iter().map(|run| run.overlap).fold(1.0, f64::min);
            println!(
                "{:10} {name:14} overlap {:.3} (worst film {worst:.3}) lost {:.1} frames, wrong {:.1}, decoy inside {:.3}",
                film.name,
                mean(|run| run.overlap),
                mean(|run| run.n_lost),
                mean(|run| run.n_wrong),
                mean(|run| run.decoy)
            );
        }
    }
    Ok(())
}

/// Figures of one film.
struct Run {
    overlap: f64,
    /// Frames in which the target is in sight, but lost.
    n_lost: f64,
    /// Frames in which the tracker is confident and wrong.
    n_wrong: f64,
    /// Share of the decoy that is inside the contour.
    decoy: f64,
}

fn follow(film: &Film, params: &ContourTrackerParams) -> Result<Run, Box<dyn std::error::Error>> {
    let mut rng = ChaCha8Rng::seed_from_u64(film.seed);
    let mut frames = film.frames()?;
    let first = frames.next().ok_or("an empty film")?;
    let [x, y, width, height] = first.target.bounding_box().ok_or("no target")?.map(|value| value as f64);
    let start = BoundingBox::from_corner(x, y, width, height)?;
    let mut tracker = if std::env::var_os("MASK").is_some() {
        ContourTracker::from_mask(&picture(&first)?, &silhouette(&first.target)?, *params)?
    } else {
        ContourTracker::from_box(&picture(&first)?, &start, *params)?
    };
    let (mut overlaps, mut n_lost, mut n_wrong, mut inside, mut n_decoy) = (Vec::new(), 0, 0, 0, 0);
    for (index, frame) in frames.enumerate() {
        let target = tracker.track(&picture(&frame)?, &mut rng)?;
        let found = mask(&target)?;
        let (truth, decoy) = (silhouette(&frame.visible)?, silhouette(&frame.decoy)?);
        let lost = target.status == TrackStatus::Lost;
        let overlap = if lost { 0.0 } else { found.iou(&silhouette(&frame.target)?)? };
        let in_sight = truth.area() > 200 && 2 * truth.area() > frame.target.area();
        if in_sight {
            overlaps.push(overlap);
        }
        n_lost += usize::from(lost && in_sight);
        n_wrong += usize::from(!lost && overlap < 0.3);
        inside += decoy.overlap(&found)?;
        n_decoy += decoy.area();
        if std::env::var_os("FRAMES").is_some() {
            let m = tracker.colors().mean;
            println!(
                "{:4} {:.3} q {:.3} lost {} color {:.3} {:.3} {:.3} area {:.0} / {}",
                index + 1,
                overlap,
                target.quality,
                lost,
                m.x,
                m.y,
                m.z,
                found.area(),
                truth.area()
            );
        }
        if std::env::var("DUMP").is_ok_and(|every| index % every.parse::<usize>().unwrap_or(10) == 0) {
            let mut bytes = frame.picture.rgb.clone();
            let rim = found.boundary();
            for (i, pixel) in bytes.chunks_exact_mut(3).enumerate() {
                if rim.get(i % 320, i / 320) {
                    pixel.copy_from_slice(if lost { &[255, 0, 0] } else { &[0, 255, 255] });
                }
            }
            image::save_buffer(
                format!("/tmp/s6/cc/{}_{}_{:03}.png", film.name, film.seed, index + 1),
                &bytes,
                320,
                240,
                image::ColorType::Rgb8,
            )?;
        }
    }
    let overlap = overlaps.iter().sum::<f64>() / overlaps.len() as f64;
    Ok(Run {
        overlap,
        n_lost: n_lost as f64,
        n_wrong: n_wrong as f64,
        decoy: inside as f64 / n_decoy.max(1) as f64,
    })
}

fn picture(frame: &Frame) -> Result<Picture, Box<dyn std::error::Error>> {
    let rgb = &frame.picture;
    Ok(Picture::from_rgb(rgb.width, rgb.height, rgb.rgb.clone())?)
}

fn mask(target: &Target) -> Result<BitMask, Box<dyn std::error::Error>> {
    Ok(BitMask::from_polygon(Film::SIZE_PX.0, Film::SIZE_PX.1, &target.outline)?)
}

fn silhouette(silhouette: &Silhouette) -> Result<BitMask, Box<dyn std::error::Error>> {
    let width = silhouette.width();
    Ok(BitMask::from_fn(width, silhouette.height(), |u, v| silhouette.pixels()[v * width + u])?)
}
