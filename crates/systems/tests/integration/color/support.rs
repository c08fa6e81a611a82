//! Drives through a simulated hall, and what the localizer makes of them.

use std::sync::Arc;

use nalgebra::{UnitQuaternion, Vector3};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_color_map::ColorMap;
use wayfix_color_model::{LightingPriors, LocalizationStatus};
use wayfix_estimation_traits::{Manifold, Pose3};
use wayfix_scene_sim::{
    league::{
        CameraSimulator, LeaguePicture, LeagueScene, LeagueVenue, LeggedRobot, LeggedRobotParams, LightField,
        LinearRgb, SceneSurface, UnmappedObjects, field_map, landmarks,
    },
    random::{RandomStreamPurpose, RandomStreams},
};
use wayfix_sensor_log::{CameraInfo, EncodedImage, Record, RecordData, Stamp};
use wayfix_systems::color::{
    self, ColorRun, ColorRunSetup, ColorSystemParams, RecordIterator, StartPose, priors,
};

/// Right: within 0.25 m and 6° of the truth.
const NEAR_M: f64 = 0.25;
const NEAR_DEG: f64 = 6.0;

/// A hall drawn from a seed, its camera set for the everyday light.
pub(crate) fn hall(seed: u64) -> LeagueVenue {
    LeagueVenue::draw(&mut ChaCha8Rng::seed_from_u64(seed)).expect("a venue")
}

/// A hall drawn from a seed, its camera set for the sun.
pub(crate) fn sunny_hall(seed: u64) -> LeagueVenue {
    let mut venue = hall(seed);
    venue.expose_for_sun();
    venue
}

/// The log of a robot with a frame every 100 ms: `light` and `spoil` get the number of the frame.
pub(crate) fn drive(
    venue: &LeagueVenue,
    n_frames: usize,
    robot: LeggedRobotParams,
    light: impl Fn(usize) -> Box<dyn LightField>,
    spoil: impl Fn(usize, &mut LeaguePicture),
) -> Vec<Record> {
    let [records] = drive_with_cameras(venue, n_frames, robot, light, spoil, [CameraOnHead::default()]);
    records
}

/// A camera on the head of the robot.
#[derive(Clone, Copy)]
pub(crate) struct CameraOnHead {
    /// Its pan to the left of the head's direction, rad.
    pub(crate) pan: f64,
    /// Its exposure relative to that of the venue.
    pub(crate) gain: f64,
    /// When it takes a picture in each tenth of a second, ms: from 1 to 100.
    pub(crate) phase_ms: usize,
}

impl Default for CameraOnHead {
    fn default() -> Self {
        Self { pan: 0.0, gain: 1.0, phase_ms: 100 }
    }
}

/// [`drive`] with several cameras: a log for each, the first with odometry and truth.
pub(crate) fn drive_with_cameras<const N: usize>(
    venue: &LeagueVenue,
    n_frames: usize,
    robot: LeggedRobotParams,
    light: impl Fn(usize) -> Box<dyn LightField>,
    spoil: impl Fn(usize, &mut LeaguePicture),
    cameras: [CameraOnHead; N],
) -> [Vec<Record>; N] {
    let mut streams = RandomStreams::new(ChaCha8Rng::seed_from_u64(7));
    let mut robot = LeggedRobot::new(robot, None, landmarks(), &mut streams).expect("a robot");
    let mut simulator = CameraSimulator::new(venue.camera).expect("a camera");
    let things = UnmappedObjects::draw(streams.of(RandomStreamPurpose::UnmappedObjects));
    let map = SceneSurface::of_map(&field_map().expect("a constant map"));
    let pinhole = venue.camera.camera;
    let info = RecordData::CameraInfo(CameraInfo {
        width: pinhole.width(),
        height: pinhole.height(),
        fx: pinhole.fx(),
        fy: pinhole.fy(),
        cx: pinhole.cx(),
        cy: pinhole.cy(),
    });
    let mut logs = cameras.map(|_| vec![at(0, info.clone())]);
    for frame in 0..n_frames {
        let light = light(frame);
        let mut moved = None;
        for phase_ms in 1..=100 {
            robot.step(&mut streams);
            let pose = robot.pose();
            if phase_ms == 100 {
                moved = Some(robot.odometry(0.1, &mut streams));
            }
            if let (Some(moved), Some(first)) = (moved, logs.first_mut()) {
                first.push(at(frame + 1, RecordData::OdometryIncrement(moved)));
                first.push(at(frame + 1, RecordData::TruePose(pose)));
            }
            let is_due = |(camera, _): &(&CameraOnHead, &mut Vec<Record>)| camera.phase_ms == phase_ms;
            for (CameraOnHead { pan, gain, .. }, records) in cameras.iter().zip(&mut logs).filter(is_due) {
                let mut surfaces = map.clone();
                surfaces.extend(things.surfaces(0.1 * frame as f64, &pose));
                let (light, backdrop) = (light.as_ref(), &venue.hall);
                let scene = LeagueScene { surfaces, paints: &venue.paints, light, backdrop };
                let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), *pan);
                let panned = |pose: Pose3<f64>| Pose3 { rotation: pose.rotation * turn, ..pose };
                let eye = panned(robot.camera_pose());
                let rng = streams.of(RandomStreamPurpose::Picture);
                let mut picture = simulator.take(&scene, [&eye, &eye], &LinearRgb::repeat(*gain), rng);
                spoil(frame, &mut picture);
                let jpeg =
                    EncodedImage::jpeg(picture.width, picture.height, &picture.rgb, 88).expect("an image");
                let mount = RecordData::CameraMount(panned(robot.reported_mount()));
                let of_frame = [mount, RecordData::Image(jpeg)];
                records.extend(of_frame.map(|data| at_ms(100 * frame + phase_ms, data)));
            }
        }
    }
    logs
}

fn at(tenths: usize, data: RecordData) -> Record {
    at_ms(100 * tenths, data)
}

fn at_ms(ms: usize, data: RecordData) -> Record {
    Record { stamp: Stamp::from_seconds(1000.0 + 0.001 * ms as f64).expect("a time"), data }
}

/// A frame of the localizer against the truth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Judged {
    pub(crate) status: LocalizationStatus,
    pub(crate) position_error: f64,
    pub(crate) heading_error_deg: f64,
    /// Standard deviations of the estimate: of the position, m, and of the heading, °.
    pub(crate) sigmas: [f64; 2],
}

impl Judged {
    pub(crate) fn is_right(&self) -> bool {
        self.position_error < NEAR_M && self.heading_error_deg < NEAR_DEG
    }

    pub(crate) fn is_tracking(&self) -> bool {
        self.status == LocalizationStatus::Tracking
    }
}

/// On the field of the league with the built-in priors, from near the truth.
pub(crate) fn localize(records: &[Record]) -> Vec<Judged> {
    let map = field_map().expect("a constant map");
    localize_with(records, map, &priors::built_in().expect("priors"), None)
}

pub(crate) fn localize_with(
    records: &[Record],
    map: ColorMap,
    priors: &LightingPriors,
    start: Option<StartPose>,
) -> Vec<Judged> {
    let run = color::run(records, setup(map, priors, start), |_| {}).expect("images");
    judged(&run)
}

/// [`localize`] with a second camera.
pub(crate) fn localize_with_second_camera(records: &[Record], second: Vec<Record>) -> Vec<Judged> {
    let map = field_map().expect("a constant map");
    let setup = setup(map, &priors::built_in().expect("priors"), None);
    let second: Option<RecordIterator> = Some(Box::new(second.into_iter()));
    let run = color::run_streamed(records, records.iter(), second, setup, |_| {}).expect("images");
    judged(&run)
}

fn setup(map: ColorMap, priors: &LightingPriors, start: Option<StartPose>) -> ColorRunSetup {
    let params = ColorSystemParams::default();
    let bank = priors::bank(priors, &params).expect("a bank");
    ColorRunSetup { map: Arc::new(map), bank, params, start, seed: 1 }
}

fn judged(run: &ColorRun) -> Vec<Judged> {
    let judge = |(frame, pose): &(&color::ColorFrameResult, wayfix_evaluation::errors::PoseWithTruth)| {
        let off: Vector3<f64> = pose.truth.local(&pose.estimate);
        let variances = frame.pose.covariance().diagonal();
        Judged {
            status: frame.status,
            position_error: off.xy().norm(),
            heading_error_deg: off.z.abs().to_degrees(),
            sigmas: [variances.xy().sum().sqrt(), variances.z.sqrt().to_degrees()],
        }
    };
    run.samples().iter().map(judge).collect()
}

/// Frames that say `tracking` at a wrong pose.
pub(crate) fn n_wrongly_tracked(frames: &[Judged]) -> usize {
    frames.iter().filter(|frame| frame.is_tracking() && !frame.is_right()).count()
}

/// One line a frame.
pub(crate) fn table(frames: &[Judged]) -> String {
    let line = |(number, frame): (usize, &Judged)| {
        let Judged { status, position_error, heading_error_deg, .. } = frame;
        format!("{number:4} {status:?} {position_error:.3} m {heading_error_deg:.1}°\n")
    };
    frames.iter().enumerate().map(line).collect()
}
