use nalgebra::Vector2;
use wayfix_estimation_traits::wrap_angle;
use wayfix_sensor_log::{Detection, DetectionTarget, RecordData};

use super::RangeBearingParams;
use super::drift::Drift;
use crate::random::{RandomStreamPurpose, RandomStreams, deviate};
use crate::sensor::{SensorReading, SimulatedSensor, TrueState};
use crate::{SimulationError, plane};

/// The sensor of [`RangeBearingParams`]. One reading holds one scan, sorted by bearing.
///
/// Every scan draws the same number of deviates for every target of the world, visible or not.
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_scene_sim::{random::RandomStreams, sensor::{TrueState, RangeBearingDetector, RangeBearingParams, SimulatedSensor}, world::{FloorPlan, PlanarWorld}};
/// use wayfix_sensor_log::{RecordData, TrueLandmark};
///
/// let world = PlanarWorld::new(FloorPlan { landmarks: vec![TrueLandmark { id: 0, x: 3.0, y: 4.0 }], walls: vec![] });
/// let pose = Pose2::new(0.0, 0.0, 0.0);
/// let moment = TrueState { milliseconds: 0, pose, wheel_angles: [0.0; 2], world: &world };
/// let mut sensor = RangeBearingDetector::new(RangeBearingParams::default())?;
/// let reading = sensor.sense(&moment, &mut RandomStreams::new(ChaCha8Rng::seed_from_u64(1)));
/// let Some(RecordData::Detections(seen)) = reading.map(|r| r.data) else { panic!("no look") };
/// assert!((seen[0].range - 5.0).abs() < 0.25); // 5σ
/// # Ok::<(), wayfix_scene_sim::SimulationError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RangeBearingDetector {
    params: RangeBearingParams,
    drifts: Vec<Drift>,
}

impl RangeBearingDetector {
    /// A sensor before its first scan.
    ///
    /// # Errors
    /// Returns [`SimulationError::Parameter`] if a parameter is out of range.
    pub fn new(params: RangeBearingParams) -> Result<Self, SimulationError> {
        params.validate()?;
        Ok(Self { params, drifts: Vec::new() })
    }

    /// Detection of one target.
    fn detect(
        &self,
        (target, point): (DetectionTarget, Vector2<f64>),
        errors: &Errors,
        moment: &TrueState<'_>,
        landmark_ids: &[u32],
    ) -> Option<Detection> {
        let (range, bearing) = plane::range_and_bearing(&moment.pose, &point);
        let in_view = (self.params.min_range_m..=self.params.max_range_m).contains(&range)
            && bearing.abs() <= self.params.half_view()
            && !moment.world.occludes(&moment.pose.translation, &point);
        if !in_view || errors.missed {
            return None;
        }
        let (range, bearing) = errors.outlier.unwrap_or((
            range * self.params.range_scale + self.params.range_bias_m + errors.range_at(range, &self.params),
            wrap_angle(bearing + self.params.bearing_bias_rad + errors.bearing(&self.params)),
        ));
        let target = errors.labelled(target, landmark_ids, self.params.labelled);
        (range > 0.0).then_some(Detection { target, range, bearing })
    }
}

impl SimulatedSensor for RangeBearingDetector {
    fn period_ms(&self) -> u32 {
        self.params.period_ms
    }

    fn sense(&mut self, moment: &TrueState<'_>, streams: &mut RandomStreams) -> Option<SensorReading> {
        let targets = moment.world.targets(moment.seconds());
        let landmark_ids: Vec<u32> = moment.world.landmarks().iter().map(|l| l.id).collect();
        self.drifts.resize(targets.len(), Drift::new(&self.params.drift));
        let mut detections = Vec::new();
        for (idx, target) in targets.into_iter().enumerate() {
            let errors = Errors::draw(&self.params, &mut self.drifts[idx], streams);
            detections.extend(self.detect(target, &errors, moment, &landmark_ids));
        }
        detections.extend(self.params.clutter.draw(&self.params, &landmark_ids, streams));
        detections.sort_by(|a, b| a.bearing.total_cmp(&b.bearing));
        let lost = deviate::chance(self.params.scan_dropout_share, streams.of(RandomStreamPurpose::Dropout));
        (!lost).then_some(SensorReading {
            data: RecordData::Detections(detections),
            stamp_offset_ms: i64::from(self.params.stamp_delay_ms),
        })
    }
}

/// Everything random about one detection, drawn before it is known whether there is one.
struct Errors {
    white: (f64, f64),
    drift: (f64, f64),
    missed: bool,
    outlier: Option<(f64, f64)>,
    /// Which landmark lends its identity, as a share of their list.
    mislabel: Option<f64>,
}

impl Errors {
    fn draw(params: &RangeBearingParams, drift: &mut Drift, streams: &mut RandomStreams) -> Self {
        let white = (
            params.noise_shape.draw(streams.of(RandomStreamPurpose::RangeNoise)),
            params.noise_shape.draw(streams.of(RandomStreamPurpose::BearingNoise)),
        );
        let drift = drift.advance(f64::from(params.period_ms) * 1e-3, streams);
        let missed = deviate::chance(params.missed_target_share, streams.of(RandomStreamPurpose::Missed));
        let rng = streams.of(RandomStreamPurpose::Outlier);
        let is_outlier = deviate::chance(params.outlier_share, rng);
        let anywhere = (
            deviate::uniform(params.min_range_m, params.max_range_m, rng),
            deviate::uniform(-params.half_view(), params.half_view(), rng),
        );
        let rng = streams.of(RandomStreamPurpose::Mislabel);
        let (is_mislabelled, which) = (deviate::chance(params.mislabelled_share, rng), deviate::unit(rng));
        Self {
            white,
            drift,
            missed,
            outlier: is_outlier.then_some(anywhere),
            mislabel: is_mislabelled.then_some(which),
        }
    }

    fn range_at(&self, range: f64, params: &RangeBearingParams) -> f64 {
        params.range_noise.at(range) * self.white.0 + params.drift.range_sigma.at(range) * self.drift.0
    }

    fn bearing(&self, params: &RangeBearingParams) -> f64 {
        params.bearing_sigma_rad * self.white.1 + params.drift.bearing_sigma_rad * self.drift.1
    }

    /// The identity written to the log.
    fn labelled(&self, target: DetectionTarget, landmark_ids: &[u32], labelled: bool) -> DetectionTarget {
        match (target, self.mislabel) {
            _ if !labelled => DetectionTarget::Unlabelled,
            (DetectionTarget::Landmark(own), Some(which)) => {
                let others = || landmark_ids.iter().filter(|id| **id != own);
                let pick = (which * others().count() as f64) as usize;
                others().nth(pick).map_or(target, |id| DetectionTarget::Landmark(*id))
            }
            _ => target,
        }
    }
}
