//! Drives through a simulated hall, and what the localizer makes of them.

use std::sync::Arc;

use nalgebra::Vector3;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_color_map::ColorMap;
use wayfix_color_model::{LightingPriors, LocalizationStatus};
use wayfix_estimation_traits::Manifold;
use wayfix_scene_sim::{
    league::{
        CameraSimulator, LeaguePicture, LeagueScene, LeagueVenue, LeggedRobot, LeggedRobotParams, LightField,
        LinearRgb, SceneSurface, UnmappedObjects, field_map, landmarks,
    },
    random::{RandomStreamPurpose, RandomStreams},
};
use wayfix_sensor_log::{CameraInfo, EncodedImage, Record, RecordData, Stamp};
use wayfix_systems::color::{self, ColorRunSetup, ColorSystemParams, StartPose, priors};

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
    let mut streams = RandomStreams::new(ChaCha8Rng::seed_from_u64(7));
    let mut robot = LeggedRobot::new(robot, None, landmarks(), &mut streams).expect("a robot");
    let mut camera = CameraSimulator::new(venue.camera).expect("a camera");
    let things = UnmappedObjects::draw(streams.of(RandomStreamPurpose::UnmappedObjects));
    let map = SceneSurface::of_map(&field_map().expect("a constant map"));
    let pinhole = venue.camera.camera;
    let mut records = vec![at(
        0,
        RecordData::CameraInfo(CameraInfo {
            width: pinhole.width(),
            height: pinhole.height(),
            fx: pinhole.fx(),
            fy: pinhole.fy(),
            cx: pinhole.cx(),
            cy: pinhole.cy(),
        }),
    )];
    for frame in 0..n_frames {
        (0..100).for_each(|_| robot.step(&mut streams));
        let (pose, moved) = (robot.pose(), robot.odometry(0.1, &mut streams));
        let mut surfaces = map.clone();
        surfaces.extend(things.surfaces(0.1 * frame as f64, &pose));
        let light = light(frame);
        let scene =
            LeagueScene { surfaces, paints: &venue.paints, light: light.as_ref(), backdrop: &venue.hall };
        let rng = streams.of(RandomStreamPurpose::Picture);
        let eye = robot.camera_pose();
        let mut picture = camera.take(&scene, [&eye, &eye], &LinearRgb::repeat(1.0), rng);
        spoil(frame, &mut picture);
        let jpeg = EncodedImage::jpeg(picture.width, picture.height, &picture.rgb, 88).expect("an image");
        let of_frame = [
            RecordData::TruePose(pose),
            RecordData::CameraMount(robot.reported_mount()),
            RecordData::Image(jpeg),
        ];
        records.push(at(frame + 1, RecordData::OdometryIncrement(moved)));
        records.extend(of_frame.map(|data| at(frame + 1, data)));
    }
    records
}

fn at(tenths: usize, data: RecordData) -> Record {
    Record { stamp: Stamp::from_seconds(1000.0 + 0.1 * tenths as f64).expect("a time"), data }
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
    let params = ColorSystemParams::default();
    let bank = priors::bank(priors, &params).expect("a bank");
    let setup = ColorRunSetup { map: Arc::new(map), bank, params, start, seed: 1 };
    let run = color::run(records, setup, |_| {}).expect("images");
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
