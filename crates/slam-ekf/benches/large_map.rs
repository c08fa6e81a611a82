//! Whole steps of a robot on laps through maps of many landmarks, full and compressed: `cargo bench -p wayfix-slam-ekf --bench large_map`.
//!
//! Prints `bench<TAB>job<TAB>program<TAB>nanoseconds` for the mean step, and on the error stream the median and the worst one.

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::Vector2;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_slam_ekf::{
    CovarianceUpdate, EkfSlam, KnownIdAssociation, LandmarkId, LandmarkModel, Observation, OdometryMotion,
    RangeBearing, RangeBearingSensor, SlamParams,
};

/// Landmarks evenly spread over a ring around a lap.
struct World {
    n_landmarks: usize,
    lap_radius: f64,
    /// How far the ring reaches to either side of the lap, m.
    half_width: f64,
    /// Steps of the filter, of a quarter of a metre.
    n_steps: usize,
}

/// The first three are nearly as dense as the `range_bearing` logs: some 13, 24 and 46 landmarks in sight. The last one is a large hall: 27.
const WORLDS: [World; 4] = [
    World { n_landmarks: 84, lap_radius: 13.0, half_width: 8.0, n_steps: 500 },
    World { n_landmarks: 156, lap_radius: 13.0, half_width: 8.0, n_steps: 500 },
    World { n_landmarks: 301, lap_radius: 13.0, half_width: 8.0, n_steps: 500 },
    World { n_landmarks: 1000, lap_radius: 75.0, half_width: 8.0, n_steps: 2000 },
];
const N_RUNS: usize = 4;
const SIGHT: f64 = 8.0;
const SEED: u64 = 84_156_301;

struct Step {
    increment: Pose2<f64>,
    look: Vec<Observation<RangeBearing>>,
}

fn main() {
    for world in &WORLDS {
        let steps = world.drive();
        for (map, name) in [(CovarianceUpdate::Full, "full"), (CovarianceUpdate::Compressed, "compressed")] {
            let mut seconds = best_of_each(world, map, &steps);
            let mean = seconds.iter().sum::<f64>() / seconds.len() as f64;
            seconds.sort_by(f64::total_cmp);
            let [median, worst] = [seconds[seconds.len() / 2], seconds[seconds.len() - 1]].map(|s| s * 1e3);
            let job = format!("step, {} landmarks, {name}", world.n_landmarks);
            println!("bench\t{job}\twayfix\t{:.1}", mean * 1e9);
            eprintln!("{job}: mean {:.3}, median {median:.3}, worst {worst:.3} ms", mean * 1e3);
        }
    }
}

/// Seconds of every step: the best of several laps, each of which does the same work, so that what interrupts the machine does not count.
fn best_of_each(world: &World, map: CovarianceUpdate, steps: &[Step]) -> Vec<f64> {
    let mut best = vec![f64::INFINITY; steps.len()];
    for _ in 0..N_RUNS {
        for (best, seconds) in best.iter_mut().zip(run(world, map, steps)) {
            *best = best.min(seconds);
        }
    }
    best
}

fn run(world: &World, map: CovarianceUpdate, steps: &[Step]) -> Vec<f64> {
    let params = SlamParams { covariance_update: map, ..SlamParams::default() };
    let mut slam =
        EkfSlam::new(RangeBearingSensor::default(), params, world.start()).expect("valid parameters");
    let motion = OdometryMotion::default();
    let mut take = |step: &Step| {
        #[allow(clippy::disallowed_methods, reason = "a benchmark measures time")]
        let start = std::time::Instant::now();
        slam.predict(&motion, &step.increment).expect("a finite increment");
        slam.update(&step.look, &mut KnownIdAssociation).expect("one association an observation");
        start.elapsed().as_secs_f64()
    };
    steps.iter().map(&mut take).collect()
}

impl World {
    fn start(&self) -> Pose2<f64> {
        Pose2::new(self.lap_radius, 0.0, FRAC_PI_2)
    }

    fn landmarks(&self, rng: &mut ChaCha8Rng) -> Vec<Vector2<f64>> {
        let place = |_| {
            let angle = TAU * rng.random::<f64>();
            let squares = [-1.0, 1.0].map(|side| (self.lap_radius + side * self.half_width).powi(2));
            let radius = (squares[0] + (squares[1] - squares[0]) * rng.random::<f64>()).sqrt();
            Vector2::new(radius * angle.cos(), radius * angle.sin())
        };
        (0..self.n_landmarks).map(place).collect()
    }

    /// Truth on a circle, errors uniform and as large as the filter takes them for.
    fn drive(&self) -> Vec<Step> {
        let mut rng = ChaCha8Rng::seed_from_u64(SEED);
        let landmarks = self.landmarks(&mut rng);
        let sensor = RangeBearingSensor::default();
        let mut error = |sigma: f64| sigma * 3f64.sqrt() * rng.random_range(-1.0..1.0);
        let motion = Pose2::new(0.25, 0.0, 0.25 / self.lap_radius);
        let mut truth = self.start();
        let mut step = |_| {
            truth = truth.compose(&motion);
            let increment = motion.compose(&Pose2::new(error(0.02), error(0.02), error(0.005)));
            let in_sight =
                (0..).zip(&landmarks).filter(|(_, place)| (*place - truth.translation).norm() < SIGHT);
            let look = in_sight.map(|(id, place)| {
                let exact = sensor.expected(&truth, place);
                let bearing = exact.bearing.radians() + error(sensor.bearing_sigma);
                let measurement = RangeBearing::new(exact.range + error(sensor.range_sigma), bearing);
                Observation { label: Some(LandmarkId(id)), measurement }
            });
            Step { increment, look: look.collect() }
        };
        (0..self.n_steps).map(&mut step).collect()
    }
}
