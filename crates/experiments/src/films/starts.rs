use anyhow::{Context, Result};
use image::imageops::{FilterType, flip_horizontal, resize};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rayon::prelude::*;
use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_sensor_log::{Log, RecordData};
use wayfix_systems::track::{BoxScore, InitialTargetRegion, TrackParams, TrackingMethod, TrueBoxes};
use wayfix_visual_tracking::{BoundingBox, RgbImage, TrackStatus};

use super::score::mean;

/// Shift of a first box in its width and height, and its scale. [Wu, Lim & Yang 2013, "spatial robustness"]
const SHIFT: f64 = 0.1;
const SCALES: [f64; 4] = [0.8, 0.9, 1.1, 1.2];
/// Number of frames that a tracker starts from. [Wu, Lim & Yang 2013, "temporal robustness"]
const N_START_FRAMES: usize = 20;

/// A frame and its true box.
type Frame = (RgbImage, BoundingBox);
type Film = Vec<Frame>;

/// A tracker on one recording from other starts: from shifted and scaled first boxes, from later frames, and in the film mirrored, reversed and at
/// half size.
///
/// # Errors
/// Returns an error if an image cannot be read or a tracker cannot start.
pub(crate) fn starts(
    log: &mut Log,
    truth: &TrueBoxes,
    method: TrackingMethod,
    params: &TrackParams,
) -> Result<ReportRun> {
    let film = read(log, truth)?;
    let overlap = |frames: &[Frame], start| follow(frames, start, method, params);
    let first = film.first().context("a film without frames")?.1;
    let shifted = shifted(&first)?.into_par_iter().map(|start| overlap(&film, start));
    let later = (0..N_START_FRAMES).into_par_iter().map(|k| {
        let frames = &film[k * film.len() / N_START_FRAMES..];
        overlap(frames, frames[0].1)
    });
    let mut metrics = Vec::new();
    let groups =
        [("shifted", shifted.collect::<Result<Vec<_>>>()?), ("later", later.collect::<Result<_>>()?)];
    for (name, overlaps) in groups {
        let least = overlaps.iter().copied().fold(f64::INFINITY, f64::min);
        metrics.push(Metric::new(format!("iou_mean_{name}_starts"), mean(&overlaps), ""));
        metrics.push(Metric::new(format!("iou_least_{name}_start"), least, ""));
    }
    for (name, film) in changed(&film)? {
        metrics.push(Metric::new(format!("iou_mean_{name}"), overlap(&film, film[0].1)?, ""));
    }
    Ok(ReportRun { metrics, ..ReportRun::default() })
}

fn read(log: &mut Log, truth: &TrueBoxes) -> Result<Film> {
    let mut film = Vec::new();
    for record in log {
        let RecordData::Image(image) = &record.data else { continue };
        let decoded = image.decode_rgb()?;
        let picture = RgbImage::from_raw(decoded.width, decoded.height, decoded.pixels);
        let truth = truth.at(film.len()).target().context("a frame without a true box")?;
        film.push((picture.context("an image has not three bytes a pixel")?, truth));
    }
    Ok(film)
}

/// The first box shifted in eight directions and scaled.
fn shifted(first: &BoundingBox) -> Result<Vec<BoundingBox>> {
    let [u, v] = first.center();
    let (width, height) = (first.width(), first.height());
    let directions = (-1..=1).flat_map(|i| (-1..=1).map(move |j| (f64::from(i), f64::from(j))));
    let shifts = directions.filter(|direction| *direction != (0.0, 0.0)).map(|(i, j)| {
        BoundingBox::from_center([u + SHIFT * i * width, v + SHIFT * j * height], width, height)
    });
    let scales = SCALES.iter().map(|scale| BoundingBox::from_center([u, v], scale * width, scale * height));
    Ok(shifts.chain(scales).collect::<Result<_, _>>()?)
}

fn changed(film: &Film) -> Result<[(&'static str, Film); 3]> {
    let with = |change: &dyn Fn(&RgbImage, &BoundingBox) -> Result<Frame>| {
        film.iter().map(|(picture, truth)| change(picture, truth)).collect::<Result<Film>>()
    };
    let mirrored = with(&|picture, truth| {
        let [x, y] = truth.corner();
        let right = f64::from(picture.width()) - x - truth.width();
        let truth = BoundingBox::from_corner(right, y, truth.width(), truth.height())?;
        Ok((flip_horizontal(picture), truth))
    })?;
    let half = with(&|picture, truth| {
        let [x, y] = truth.corner();
        let truth = BoundingBox::from_corner(x / 2.0, y / 2.0, truth.width() / 2.0, truth.height() / 2.0)?;
        Ok((resize(picture, picture.width() / 2, picture.height() / 2, FilterType::Triangle), truth))
    })?;
    let reversed = film.iter().rev().cloned().collect();
    Ok([("mirrored", mirrored), ("reversed", reversed), ("half_size", half)])
}

/// Mean overlap over the frames, 0 where the target is reported lost.
fn follow(frames: &[Frame], start: BoundingBox, method: TrackingMethod, params: &TrackParams) -> Result<f64> {
    let mut tracker = method.begin(params, &frames[0].0, &InitialTargetRegion::Box(start))?;
    let (mut rng, mut score) = (ChaCha8Rng::seed_from_u64(0), BoxScore::default());
    score.add(Some(&start), &frames[0].1);
    for (picture, truth) in &frames[1..] {
        let target = tracker.track_frame(picture, &mut rng)?;
        score.add((target.status == TrackStatus::Tracked).then_some(&target.bounding_box), truth);
    }
    score.iou_mean().context("a film without frames")
}
