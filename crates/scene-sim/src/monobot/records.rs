use std::f64::consts::PI;

use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{Detection, DetectionTarget, Record, RecordData, Stamp, TrueLandmark};

use super::MonobotRun;

impl MonobotRun {
    /// The drive as the log of a planar robot on the x axis, one step every `period_ms`: commands as odometry increments, a range
    /// with bearing 0, or π for a landmark behind.
    ///
    /// ```
    /// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
    /// use wayfix_scene_sim::{monobot::MonobotParams, random::RandomStreams};
    /// use wayfix_sensor_log::Stamp;
    /// let run = MonobotParams::default().simulate(&mut RandomStreams::new(ChaCha8Rng::seed_from_u64(1)))?;
    /// let records = run.records(Stamp::from_nanoseconds(0), 100);
    /// assert_eq!(records.len(), 1 + 101 + 100 + 101); // landmark, true poses, increments, observations
    /// # Ok::<(), wayfix_scene_sim::SimulationError>(())
    /// ```
    pub fn records(&self, start: Stamp, period_ms: u32) -> Vec<Record> {
        let landmarks = self.landmarks.iter().zip(0..).map(|(x, id)| Record {
            stamp: start,
            data: RecordData::TrueLandmark(TrueLandmark { id, x: *x, y: 0.0 }),
        });
        let steps = self.positions.iter().zip(&self.ranges).enumerate().flat_map(|(k, (x, ranges))| {
            let after_start = (k as u64).saturating_mul(u64::from(period_ms)).saturating_mul(1_000_000);
            let stamp = Stamp::from_nanoseconds(start.nanoseconds().saturating_add(after_start));
            let on_line = |x| Pose2::new(x, 0.0, 0.0);
            let increment =
                k.checked_sub(1).map(|k| RecordData::OdometryIncrement(on_line(self.controls[k])));
            [RecordData::TruePose(on_line(*x))]
                .into_iter()
                .chain(increment)
                .chain([RecordData::Detections(detections(ranges))])
                .map(move |data| Record { stamp, data })
        });
        landmarks.chain(steps).collect()
    }
}

fn detections(ranges: &[f64]) -> Vec<Detection> {
    let detection = |(range, id): (&f64, u32)| Detection {
        target: DetectionTarget::Landmark(id),
        range: range.abs(),
        bearing: if *range < 0.0 { PI } else { 0.0 },
    };
    ranges.iter().zip(0..).map(detection).collect()
}
