#![allow(non_local_definitions, reason = "each size needs its implementations beside its run")]

use adskalman::{
    CovarianceUpdateMethod, KalmanFilterNoControl, ObservationModel, StateAndCovariance, TransitionModelLinearNoControl,
};
use nalgebra::{Const, SMatrix, SVector};

use crate::{harness::measure, jobs::transition};

struct Motion<const N: usize> {
    f: SMatrix<f64, N, N>,
    ft: SMatrix<f64, N, N>,
    q: SMatrix<f64, N, N>,
}

struct Sensor<const N: usize, const M: usize> {
    h: SMatrix<f64, M, N>,
    ht: SMatrix<f64, N, M>,
    r: SMatrix<f64, M, M>,
}

/// The traits' bounds want dimensions by name, so each size is spelled out.
macro_rules! job {
    ($n:literal, $m:literal, $name:literal, $calls:literal) => {{
        impl TransitionModelLinearNoControl<f64, Const<$n>> for Motion<$n> {
            fn F(&self) -> &SMatrix<f64, $n, $n> {
                &self.f
            }
            fn FT(&self) -> &SMatrix<f64, $n, $n> {
                &self.ft
            }
            fn Q(&self) -> &SMatrix<f64, $n, $n> {
                &self.q
            }
        }
        impl ObservationModel<f64, Const<$n>, Const<$m>> for Sensor<$n, $m> {
            fn H(&self) -> &SMatrix<f64, $m, $n> {
                &self.h
            }
            fn HT(&self) -> &SMatrix<f64, $n, $m> {
                &self.ht
            }
            fn R(&self) -> &SMatrix<f64, $m, $m> {
                &self.r
            }
        }
        let f = SMatrix::<f64, $n, $n>::from_column_slice(transition($n).as_slice());
        let h = SMatrix::<f64, $m, $n>::identity();
        let motion = Motion { f, ft: f.transpose(), q: SMatrix::identity() * 1e-3 };
        let sensor = Sensor { h, ht: h.transpose(), r: SMatrix::identity() * 0.1 };
        let z = SVector::<f64, $m>::repeat(0.5);
        for (program, method) in [
            ("adskalman 0.18 joseph", CovarianceUpdateMethod::JosephForm),
            ("adskalman 0.18 plain", CovarianceUpdateMethod::OptimalKalman),
        ] {
            let filter = KalmanFilterNoControl::new(&motion, &sensor);
            let mut state = StateAndCovariance::new(SVector::<f64, $n>::zeros(), SMatrix::identity());
            measure($name, program, $calls, || {
                state = filter.step_with_options(&state, &z, method).expect("well conditioned");
            });
        }
    }};
}

pub fn run() {
    job!(4, 2, "kalman 4/2", 20_000);
    job!(30, 30, "kalman 30/30", 300);
}
