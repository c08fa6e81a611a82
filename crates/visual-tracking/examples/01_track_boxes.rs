//! Follows the target of a sequence from its first box and compares every box with the truth: mean overlap, success, precision.
//!
//! `cargo run --release -p wayfix-visual-tracking --example 04_track_boxes -- FOLDER… [parameter=value…]`, where each folder holds the frames in
//! `img` and a line `x,y,w,h` for each in `groundtruth_rect.txt`. With `out=FOLDER`, the boxes are written there;
//! `tracker=` is `correlation` or `head`.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_visual_tracking::{
    BoundingBox, CorrelationTracker, CorrelationTrackerParams, HeadTracker, HeadTrackerParams, RgbImage,
    TargetEstimate, TrackStatus, Tracker, TrackingError,
};

#[derive(Default)]
struct Params {
    correlation: CorrelationTrackerParams,
    head: HeadTrackerParams,
}

/// One of the trackers that start from a box.
enum Any {
    Correlation(Box<CorrelationTracker>),
    Head(Box<HeadTracker>),
}

impl Any {
    fn start(
        name: &str,
        picture: &RgbImage,
        first: BoundingBox,
        params: &Params,
    ) -> Result<Self, Box<dyn Error>> {
        Ok(match name {
            "correlation" => Self::Correlation(Box::new(CorrelationTracker::new(
                picture,
                first,
                params.correlation.clone(),
            )?)),
            "head" => Self::Head(Box::new(HeadTracker::new(picture, first, params.head.clone())?)),
            _ => return Err(format!("no tracker {name}").into()),
        })
    }

    fn track(&mut self, picture: &RgbImage, rng: &mut ChaCha8Rng) -> Result<TargetEstimate, TrackingError> {
        match self {
            Self::Correlation(tracker) => tracker.track(picture, rng),
            Self::Head(tracker) => tracker.track(picture, rng),
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let (options, folders): (Vec<String>, Vec<String>) =
        std::env::args().skip(1).partition(|argument| argument.contains('='));
    let mut all = Params::default();
    let mut out = None;
    let mut name_of_tracker = String::from("correlation");
    for option in &options {
        let (name, value) = option.split_once('=').ok_or("name=value")?;
        let number = || value.parse::<f64>();
        let (params, head) = (&mut all.correlation, &mut all.head);
        match name {
            "search_window_scale" => params.search_window_scale = number()?,
            "target_response_width" => params.target_response_width = number()?,
            "previous_filter_weight" => params.previous_filter_weight = number()?,
            "color_channel_share" => params.color_channel_share = number()?,
            "color_histogram_weight" => params.color_histogram_weight = number()?,
            "motion_sigma" => params.motion_sigma = number()?,
            "n_scale_hypotheses" => params.n_scale_hypotheses = value.parse()?,
            "scale_step" => params.scale_step = number()?,
            "min_recognition_response_share" => params.min_recognition_response_share = number()?,
            "recognize_above_psr" => params.recognize_above_psr = number()?,
            "accept_change_after_n_frames" => params.accept_change_after_n_frames = value.parse()?,
            "learn_above_psr" => params.learn_above_psr = number()?,
            "lost_after_n_frames" => params.lost_after_n_frames = value.parse()?,
            "bimodal_colors" => head.bimodal_colors = value.parse()?,
            "search_radius" => head.search_radius = number()?,
            "head_scale_step" => head.scale_step = number()?,
            "gradient_weight" => head.gradient_weight = Some(number()?),
            "color_adaptation_rate" => head.color_adaptation_rate = number()?,
            "adapt_above_intersection" => head.adapt_above_intersection = number()?,
            "tracker" => value.clone_into(&mut name_of_tracker),
            "out" => out = Some(PathBuf::from(value)),
            _ => return Err(format!("no parameter {name}").into()),
        }
    }
    println!(
        "{:28} {:>6} {:>6} {:>6} {:>5} {:>5} {:>5} {:>7}",
        "sequence", "iou", "auc", "p20", "n", "lost", "alone", "ms"
    );
    let mut total = [0.0; 3];
    for folder in &folders {
        let row = follow(Path::new(folder), &name_of_tracker, &all, out.as_deref())?;
        for i in 0..3 {
            total[i] += row[i] / folders.len() as f64;
        }
    }
    println!("{:28} {:6.3} {:6.3} {:6.3}", "mean", total[0], total[1], total[2]);
    Ok(())
}

fn follow(
    folder: &Path,
    name_of_tracker: &str,
    params: &Params,
    out: Option<&Path>,
) -> Result<[f64; 3], Box<dyn Error>> {
    let truth: Vec<Option<BoundingBox>> = fs::read_to_string(folder.join("groundtruth_rect.txt"))?
        .lines()
        .map(parse)
        .collect::<Result<_, _>>()?;
    let mut frames: Vec<PathBuf> = fs::read_dir(folder.join("img"))?
        .map(|entry| Ok(entry?.path()))
        .collect::<Result<_, std::io::Error>>()?;
    frames.sort();
    let mut rng = ChaCha8Rng::seed_from_u64(0);
    let mut tracker: Option<Any> = None;
    let (mut overlaps, mut near, mut lost, mut alone, mut seconds) = (Vec::new(), 0, 0, 0, 0.0);
    let mut lines = String::new();
    for (path, &truth) in frames.iter().zip(&truth) {
        let decoded = image::open(path)?.to_rgb8();
        let picture = RgbImage::from_raw(
            (decoded.width() as usize) as u32,
            (decoded.height() as usize) as u32,
            decoded.into_raw(),
        )
        .expect("3 bytes a pixel");
        #[allow(clippy::disallowed_methods)] // an example may measure time
        let start = Instant::now();
        let (found, status) = match &mut tracker {
            None => {
                let first = truth.ok_or("no box in the first frame")?;
                tracker = Some(Any::start(name_of_tracker, &picture, first, params)?);
                (first, TrackStatus::Tracked)
            }
            Some(tracker) => {
                let target = tracker.track(&picture, &mut rng)?;
                (target.bounding_box, target.status)
            }
        };
        seconds += start.elapsed().as_secs_f64();
        let corner = found.corner();
        let is_lost = status == TrackStatus::Lost;
        let row = [corner[0], corner[1], found.width(), found.height()].map(|value| format!("{value:.2}"));
        lines += &format!("{},{is_lost}\n", row.join(","));
        let Some(truth) = truth else {
            alone += usize::from(!is_lost);
            continue;
        };
        let iou = if is_lost { 0.0 } else { found.iou(&truth) };
        lost += usize::from(is_lost);
        let [a, b] = [found.center(), truth.center()];
        near += usize::from(!is_lost && (a[0] - b[0]).hypot(a[1] - b[1]) <= 20.0);
        overlaps.push(iou);
    }
    if let Some(out) = out {
        fs::create_dir_all(out)?;
        fs::write(out.join(folder.file_name().ok_or("a folder")?).with_extension("csv"), &lines)?;
    }
    let n = overlaps.len() as f64;
    let share = |threshold: f64| overlaps.iter().filter(|&&iou| iou > threshold).count() as f64 / n;
    let iou = overlaps.iter().sum::<f64>() / n;
    let auc = (0..=20).map(|i| share(f64::from(i) * 0.05)).sum::<f64>() / 21.0;
    let near = f64::from(near as u32) / n;
    let name = folder.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    println!(
        "{name:28} {iou:6.3} {auc:6.3} {near:6.3} {n:5} {lost:5} {alone:5} {:7.2}",
        1000.0 * seconds / lines.lines().count() as f64
    );
    Ok([iou, auc, near])
}

/// Corners of such files count from 1.
fn parse(line: &str) -> Result<Option<BoundingBox>, Box<dyn Error>> {
    let numbers: Vec<f64> = line
        .split(|c: char| c == ',' || c.is_whitespace())
        .filter(|part| !part.is_empty())
        .map(str::parse)
        .collect::<Result<_, _>>()?;
    let [x, y, w, h] = numbers[..] else { return Err("four numbers a line".into()) };
    Ok(if w > 0.0 && h > 0.0 { Some(BoundingBox::from_corner(x - 1.0, y - 1.0, w, h)?) } else { None })
}
