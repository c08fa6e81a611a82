use kfilter::{Kalman1M, KalmanPredict};
use nalgebra_034::{SMatrix, SVector};

use crate::{harness::measure, jobs::transition};

pub fn run() {
    job::<4, 2>("kalman 4/2", 20_000);
    job::<30, 30>("kalman 30/30", 300);
}

fn job<const N: usize, const M: usize>(name: &str, calls: u32) {
    let f = SMatrix::<f64, N, N>::from_column_slice(transition(N).as_slice());
    let h = SMatrix::<f64, M, N>::identity();
    let mut filter = Kalman1M::new(f, SMatrix::identity() * 1e-3, h, SMatrix::identity() * 0.1, SVector::zeros());
    let z = SVector::<f64, M>::repeat(0.5);
    measure(name, "kfilter 0.5", calls, || {
        filter.predict().expect("linear");
        filter.update(z).expect("well conditioned");
    });
}
