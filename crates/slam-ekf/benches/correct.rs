//! One joint correction of a map, in nanoseconds: `cargo bench -p wayfix-slam-ekf`.
//!
//! Prints `bench<TAB>job<TAB>program<TAB>nanoseconds`, and on the error stream how many multiply-adds that was per nanosecond beside what a
//! product of large square matrices reaches here, which is the limit.

use std::hint::black_box;

use nalgebra::{DMatrix, Matrix2, Matrix3, Vector2};
use wayfix_estimation_traits::Pose2;
use wayfix_slam_ekf::{
    EkfSlam, KnownIdAssociation, LandmarkId, LandmarkModel, Observation, RangeBearing, RangeBearingSensor,
    SlamParams,
};

/// Landmarks in the map and seen in one look, as in the three `range_bearing` logs.
const JOBS: [(usize, usize); 3] = [(84, 14), (156, 26), (301, 51)];

fn main() {
    let limit = product_rate();
    eprintln!("limit: {limit:.2} multiply-adds per ns");
    for (n_landmarks, n_seen) in JOBS {
        let (mut slam, look) = map(n_landmarks, n_seen);
        let calls = 3_000_000 / (n_landmarks * n_landmarks * n_seen) + 3;
        let seconds = best_of(15, calls, || {
            slam.update(&look, &mut KnownIdAssociation).expect("one association an observation").n_accepted()
        });
        println!("bench\tjoint correction {n_landmarks}/{n_seen}\twayfix\t{:.1}", seconds * 1e9);
        let rate = multiply_adds(3 + 2 * n_landmarks, 2 * n_seen) / (seconds * 1e9);
        eprintln!("{n_landmarks}/{n_seen}: {rate:.2} multiply-adds per ns, {:.2} of the limit", rate / limit);
    }
}

/// What the correction of `n` states by `m` rows needs: one product on one triangle, one triangular solve, one factorization. What is
/// done beyond that, in panels that stick out of the triangle and in copies, counts as lost.
fn multiply_adds(n: usize, m: usize) -> f64 {
    let (n, m) = (n as f64, m as f64);
    0.5 * n * n * m + 0.5 * n * m * m + m * m * m / 6.0
}

/// A map that has settled: every landmark seen twice from where the robot stands.
fn map(n_landmarks: usize, n_seen: usize) -> (EkfSlam<RangeBearingSensor>, Vec<Observation<RangeBearing>>) {
    let start = Pose2::new(0.0, 0.0, 0.0);
    let sensor = RangeBearingSensor::default();
    let mut slam = EkfSlam::with_start_covariance(sensor, SlamParams::default(), start, Matrix3::identity())
        .expect("valid parameters");
    let place = |i: usize| {
        let (sin, cos) = (2.4 * i as f64).sin_cos(); // the golden angle spreads them
        Vector2::new(cos, sin) * (1.0 + i as f64).sqrt()
    };
    for i in 0..n_landmarks {
        slam.insert(LandmarkId(i as u32), place(i), Matrix2::identity() * 0.01).expect("a valid landmark");
    }
    let observation = |i: usize| Observation {
        label: Some(LandmarkId(i as u32)),
        measurement: sensor.expected(&start, &place(i)),
    };
    let all: Vec<_> = (0..n_landmarks).map(observation).collect();
    slam.update(&all, &mut KnownIdAssociation).expect("one association an observation");
    let look = all.into_iter().step_by(n_landmarks / n_seen).take(n_seen).collect();
    (slam, look)
}

/// Multiply-adds per nanosecond of a 512 × 512 product, single-threaded.
fn product_rate() -> f64 {
    const N: usize = 512;
    let a = DMatrix::from_fn(N, N, |row, column| (row + 2 * column) as f64 * 1e-3);
    let mut c = DMatrix::zeros(N, N);
    let seconds = best_of(15, 1, || {
        c.gemm(1.0, &a, &a, 0.0);
        c[(0, 0)]
    });
    (N * N * N) as f64 / (seconds * 1e9)
}

/// Seconds of one call: the best of `batches`, each of `calls`.
fn best_of<O>(batches: usize, calls: usize, mut job: impl FnMut() -> O) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..batches {
        #[allow(clippy::disallowed_methods, reason = "a benchmark measures time")]
        let start = std::time::Instant::now();
        for _ in 0..calls {
            black_box(job());
        }
        best = best.min(start.elapsed().as_secs_f64() / calls as f64);
    }
    best
}
