use nalgebra::{DMatrix, DVector, SMatrix, SVector};
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::{
    ExtendedKalmanAlgorithm, GaussianFilter, InformationFilterAlgorithm, KalmanAlgorithm, KalmanFilter,
    LinearMotion, LinearSensor, SquareRootKalmanAlgorithm, UnscentedKalmanAlgorithm,
};

use crate::harness::measure;

/// Our filters on the jobs of `docs/performance.md`.
pub(crate) fn run() {
    fixed::<4, 2>("kalman 4/2", 20_000);
    fixed::<30, 30>("kalman 30/30", 300);
    dynamic(4, 2, "kalman 4/2 dynamic", 10_000);
    dynamic(30, 30, "kalman 30/30 dynamic", 300);
    form("kalman 4/2", "wayfix extended", ExtendedKalmanAlgorithm);
    form("kalman 4/2", "wayfix square-root", SquareRootKalmanAlgorithm);
    form("kalman 4/2", "wayfix information", InformationFilterAlgorithm);
    form("kalman 4/2", "wayfix unscented", UnscentedKalmanAlgorithm::default());
}

/// The first half of the state moves with the second; the first entries are seen.
pub(crate) fn transition(n: usize) -> DMatrix<f64> {
    DMatrix::from_fn(n, n, |i, j| {
        if i == j {
            1.0
        } else if i + n / 2 == j {
            0.1
        } else {
            0.0
        }
    })
}

fn fixed<const N: usize, const M: usize>(job: &str, calls: u32) {
    let f = SMatrix::<f64, N, N>::from_column_slice(transition(N).as_slice());
    let motion = LinearMotion::new(f, SMatrix::identity() * 1e-3).expect("a valid motion");
    let sensor = LinearSensor::new(SMatrix::<f64, M, N>::identity(), SMatrix::<f64, M, M>::identity() * 0.1)
        .expect("a valid sensor");
    let prior = Gaussian::new(SVector::<f64, N>::zeros(), SMatrix::identity()).expect("a valid prior");
    let z = SVector::<f64, M>::repeat(0.5);
    let mut filter = KalmanFilter::new(motion, prior).expect("sizes fit");
    let mut plain = filter.clone();
    measure(job, "wayfix joseph", calls, || {
        filter.predict(None).expect("well conditioned");
        filter.update(&sensor, &z).expect("well conditioned");
    });
    measure(job, "wayfix plain", calls, || {
        plain.predict(None).expect("well conditioned");
        plain.update_plain(&sensor, &z).expect("well conditioned");
    });
}

fn dynamic(n: usize, m: usize, job: &str, calls: u32) {
    let motion = LinearMotion::new(transition(n), DMatrix::identity(n, n) * 1e-3).expect("a valid motion");
    let sensor =
        LinearSensor::new(DMatrix::identity(m, n), DMatrix::identity(m, m) * 0.1).expect("a valid sensor");
    let prior = Gaussian::new(DVector::zeros(n), DMatrix::identity(n, n)).expect("a valid prior");
    let z = DVector::repeat(m, 0.5);
    let mut filter = KalmanFilter::new(motion, prior).expect("sizes fit");
    let mut plain = filter.clone();
    measure(job, "wayfix joseph", calls, || {
        filter.predict(None).expect("well conditioned");
        filter.update(&sensor, &z).expect("well conditioned");
    });
    measure(job, "wayfix plain", calls, || {
        plain.predict(None).expect("well conditioned");
        plain.update_plain(&sensor, &z).expect("well conditioned");
    });
}

fn form<F: KalmanAlgorithm<SVector<f64, 4>>>(job: &str, program: &str, form: F) {
    let f = SMatrix::<f64, 4, 4>::from_column_slice(transition(4).as_slice());
    let motion = LinearMotion::new(f, SMatrix::identity() * 1e-3).expect("a valid motion");
    let sensor = LinearSensor::new(SMatrix::<f64, 2, 4>::identity(), SMatrix::<f64, 2, 2>::identity() * 0.1)
        .expect("a valid sensor");
    let prior = Gaussian::new(SVector::<f64, 4>::zeros(), SMatrix::identity()).expect("a valid prior");
    let z = SVector::<f64, 2>::repeat(0.5);
    let mut filter = GaussianFilter::new(motion, form, prior).expect("a valid prior");
    measure(job, program, 10_000, || {
        filter.predict(&None).expect("well conditioned");
        filter.update(&sensor, &z).expect("well conditioned");
    });
}
