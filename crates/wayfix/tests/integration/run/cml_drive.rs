//! A drive with panoramas, as a log and as a folder, and `wayfix run cml` on it.
#![allow(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use std::{ffi::OsStr, fmt::Write, fs, path::PathBuf};

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::Pose2;
use wayfix_scene_sim::{
    indoors::{IndoorDrive, IndoorDriveParams, RetailStore, RetailStoreParams, calibrated_robot},
    random::RandomStreams,
};
use wayfix_sensor_log::{EncodedImage, LogFormat, Record, RecordData, Stamp};

use crate::common::{Outcome, Scratch, wayfix};

pub(crate) const WORLD_SEED: u64 = 5;
pub(crate) const LAPS: usize = 2;

/// What a drive round the shelves of the area gives: pictures and true poses 0.25 m apart.
pub(crate) struct Drive {
    pub(crate) frames: Vec<(EncodedImage, Pose2<f64>, Option<Pose2<f64>>)>,
}

impl Drive {
    pub(crate) fn new() -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(WORLD_SEED);
        let building = RetailStore::draw(RetailStoreParams::area(), &mut rng).unwrap().building();
        let route = building.aisles().laps(LAPS, &mut rng).unwrap();
        let params = IndoorDriveParams { robot: calibrated_robot(&mut rng), ..IndoorDriveParams::default() };
        let steps = IndoorDrive::new(&building, route, params, RandomStreams::new(rng)).unwrap();
        let frame = |step: wayfix_scene_sim::indoors::IndoorDriveStep| {
            let view = &step.view;
            let image = EncodedImage::png_rgb(view.width as u32, view.height as u32, &view.rgb).unwrap();
            (image, step.pose, step.odometry)
        };
        Self { frames: steps.take(260).map(frame).collect() }
    }

    /// The frames as `0001.png …` in a folder.
    pub(crate) fn folder(&self, scratch: &Scratch) -> PathBuf {
        let folder = scratch.path("frames");
        fs::create_dir_all(&folder).unwrap();
        for (index, (image, ..)) in self.frames.iter().enumerate() {
            fs::write(folder.join(format!("view_{index}.png")), &image.bytes).unwrap();
        }
        folder
    }

    pub(crate) fn table(&self, row: impl Fn(usize, &Pose2<f64>) -> String) -> String {
        let mut text = String::new();
        for (index, (_, pose, _)) in self.frames.iter().enumerate() {
            writeln!(text, "{}", row(index, pose)).unwrap();
        }
        text
    }

    pub(crate) fn records(&self) -> Vec<Record> {
        let mut records = Vec::new();
        for (index, (image, pose, odometry)) in self.frames.iter().enumerate() {
            let stamp = Stamp::from_nanoseconds(500_000_000 * index as u64);
            let mut push = |data| records.push(Record { stamp, data });
            push(RecordData::TruePose(*pose));
            odometry.iter().for_each(|odometry| push(RecordData::OdometryIncrement(*odometry)));
            push(RecordData::Image(image.clone()));
        }
        records
    }

    pub(crate) fn log(&self, scratch: &Scratch) -> PathBuf {
        let path = scratch.path("area.mcap");
        wayfix_sensor_log::write(&path, LogFormat::Mcap, self.records()).unwrap();
        path
    }
}

pub(crate) fn run_cml(arguments: &[&OsStr]) -> Outcome {
    let first = ["run", "cml", "--json"].map(OsStr::new);
    wayfix(first.into_iter().chain(arguments.iter().copied()))
}

pub(crate) fn frames_run(folder: &PathBuf, poses: &PathBuf, more: &[&str]) -> Outcome {
    let mut arguments = vec![OsStr::new("--frames"), folder.as_ref(), OsStr::new("--poses"), poses.as_ref()];
    arguments.extend(more.iter().map(OsStr::new));
    run_cml(&arguments)
}

pub(crate) fn log_run(log: &PathBuf, more: &[&str]) -> Outcome {
    let mut arguments = vec![OsStr::new("--log"), log.as_ref()];
    arguments.extend(more.iter().map(OsStr::new));
    run_cml(&arguments)
}
