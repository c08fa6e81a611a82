use std::{f64::consts::PI, path::Path, sync::Arc};

use anyhow::{Context, Result, ensure};
use rayon::prelude::*;
use wayfix_color_map::ColorMap;
use wayfix_color_model::{LightingFilterBank, LocalizationStatus};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_evaluation::{
    errors::PoseWithTruth,
    report::{Metric, ReportRun},
};
use wayfix_sensor_log::{LogOpenOptions, Record, RecordData, Stamp};
use wayfix_systems::color::{
    ColorRunSetup, ColorSystemParams, StartPose, StartPoseUncertainty, priors, read_map, run,
};

/// A start that people state for a robot which they put down: half a metre, 15°.
const NEAR: StartPoseUncertainty = StartPoseUncertainty { position_sigma: 0.5, heading_sigma: PI / 12.0 };
/// A pose is right within these of the true one.
const MAX_POSITION_ERROR: f64 = 0.25;
const MAX_HEADING_ERROR: f64 = PI / 30.0;

/// Localization of a standing robot at places of a real field, from near and from anywhere: bags `bags/PLACE`, `field.toml` and `priors-red1.json` in `folder`.
///
/// Each bag runs twice in a row. The field is symmetric by half a turn, but for the landmarks. Shares are of all runs, at the last image; those `after_one_turn` are at the last
/// image of the first turn.
///
/// # Errors
/// Returns an error if a file is missing, or no image of a bag can be used.
pub(crate) fn real_places(
    folder: &Path,
    places: &[String],
    seeds: impl Iterator<Item = u64>,
    params: &ColorSystemParams,
) -> Result<ReportRun> {
    let field = Field {
        map: Arc::new(read_map(&folder.join("field.toml"))?),
        bank: priors::bank(&priors::read(&folder.join("priors-red1.json"))?, params)?,
        params: ColorSystemParams { start_uncertainty: NEAR, ..params.clone() },
    };
    let seeds: Vec<u64> = seeds.collect();
    let mut metrics = vec![Metric::new("n_places", places.len() as f64, "")];
    for (name, start) in [("near", None), ("anywhere", Some(StartPose::Anywhere))] {
        let runs: Vec<(&String, u64)> =
            places.iter().flat_map(|place| seeds.iter().map(move |seed| (place, *seed))).collect();
        let outcomes = runs.par_iter().map(|(place, seed)| {
            let (records, end_of_turn) =
                twice(folder.join("bags").join(place).as_path()).context(place.to_string())?;
            field.localize((&records, end_of_turn), start, *seed).context(place.to_string())
        });
        metrics.extend(summary(name, &outcomes.collect::<Result<Vec<_>>>()?));
    }
    Ok(ReportRun { metrics, ..ReportRun::default() })
}

struct Field {
    map: Arc<ColorMap>,
    bank: LightingFilterBank,
    params: ColorSystemParams,
}

/// A pose against the true one.
struct Place {
    is_right: bool,
    /// Right after half a turn of the field.
    is_mirrored: bool,
}

/// A run at a place.
struct Outcome {
    /// Where it ends after each turn of the bag.
    places: [Place; 2],
    n_false_tracking_frames: usize,
    /// Those that half a turn of the field does not make right.
    n_false_tracking_frames_modulo_symmetry: usize,
}

impl Field {
    fn localize(
        &self,
        (records, end_of_turn): (&[Record], Stamp),
        start: Option<StartPose>,
        seed: u64,
    ) -> Result<Outcome> {
        let setup = ColorRunSetup { start, ..ColorRunSetup::new(&self.map, &self.bank, &self.params, seed) };
        let run = run(records, setup, |_| {})?;
        let samples = run.samples();
        let until = |end: Stamp| {
            let last = samples.iter().rev().find(|(frame, _)| frame.stamp <= end);
            let (_, sample) = last.context("the bag has no true pose at its images")?;
            anyhow::Ok(Place { is_right: is_right(sample), is_mirrored: is_mirrored(sample) })
        };
        let places = [until(end_of_turn)?, until(Stamp::from_nanoseconds(u64::MAX))?];
        let tracking = samples.iter().filter(|(frame, _)| frame.status == LocalizationStatus::Tracking);
        let false_poses: Vec<_> = tracking.map(|(_, at)| at).filter(|at| !is_right(at)).collect();
        Ok(Outcome {
            places,
            n_false_tracking_frames: false_poses.len(),
            n_false_tracking_frames_modulo_symmetry: false_poses.iter().filter(|at| !is_mirrored(at)).count(),
        })
    }
}

fn is_right(sample: &PoseWithTruth) -> bool {
    let error = sample.error();
    error.xy().norm() <= MAX_POSITION_ERROR && error.z.abs() <= MAX_HEADING_ERROR
}

/// Whether the pose is right after half a turn of the field.
fn is_mirrored(sample: &PoseWithTruth) -> bool {
    let half_a_turn = Pose2::new(0.0, 0.0, PI);
    is_right(&PoseWithTruth { truth: half_a_turn.compose(&sample.truth), ..*sample })
}

fn summary(start: &str, outcomes: &[Outcome]) -> Vec<Metric> {
    let n = outcomes.len() as f64;
    let share =
        |holds: &dyn Fn(&Outcome) -> bool| outcomes.iter().filter(|one| holds(one)).count() as f64 / n;
    let most = |number: fn(&Outcome) -> usize| outcomes.iter().map(number).max().unwrap_or(0) as f64;
    let shares = ["_after_one_turn", ""].into_iter().enumerate().flat_map(|(turn, when)| {
        let right = share(&|one| one.places[turn].is_right);
        let modulo_symmetry = share(&|one| one.places[turn].is_right || one.places[turn].is_mirrored);
        [
            Metric::new(format!("{start}_right_share{when}"), right, ""),
            Metric::new(format!("{start}_right_share_modulo_symmetry{when}"), modulo_symmetry, ""),
        ]
    });
    let mut metrics = vec![Metric::new(format!("{start}_n_runs"), n, "")];
    metrics.extend(shares);
    metrics.extend([
        Metric::new(
            format!("{start}_n_false_tracking_frames_worst"),
            most(|one| one.n_false_tracking_frames),
            "",
        ),
        Metric::new(
            format!("{start}_n_false_tracking_frames_modulo_symmetry_worst"),
            most(|one| one.n_false_tracking_frames_modulo_symmetry),
            "",
        ),
    ]);
    metrics
}

/// The records of a bag, and again after them, with the stamp of the last image of the first turn.
fn twice(bag: &Path) -> Result<(Vec<Record>, Stamp)> {
    let (mut records, _) = wayfix_sensor_log::open(bag, &LogOpenOptions::default())?.read_all();
    let images: Vec<Stamp> = records
        .iter()
        .filter(|record| matches!(record.data, RecordData::Image(_)))
        .map(|record| record.stamp)
        .collect();
    let [first, second, .., last] = images[..] else { anyhow::bail!("fewer than three images") };
    let nanoseconds = |stamp: Stamp| stamp.nanoseconds();
    ensure!(first < second && second < last, "the images are not in order");
    let period = nanoseconds(last) - nanoseconds(first) + nanoseconds(second) - nanoseconds(first);
    let later = |record: &Record| Record {
        stamp: Stamp::from_nanoseconds(nanoseconds(record.stamp) + period),
        ..record.clone()
    };
    records.extend(records.iter().map(later).collect::<Vec<_>>());
    records.sort_by_key(|record| record.stamp);
    Ok((records, last))
}
