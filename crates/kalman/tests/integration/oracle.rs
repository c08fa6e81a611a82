//! Figures of filterpy 2.0.0 (numpy 2.4.6, scipy 1.17.1), made by `oracle/make.py` beside this file.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot build its models has failed")]

use crate::common::{TrackSensor, constant_velocity, track_prior};
use approx::assert_abs_diff_eq;
use nalgebra::{Matrix2, Matrix2x4, Matrix4, Vector2, Vector4};
use wayfix_estimation_traits::{Manifold, SensorModel};
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::{
    ExtendedKalmanAlgorithm, GaussianFilter, ImmFilter, KalmanFilter, LinearMotion, LinearSensor,
    MarkovChain, UnscentedKalmanAlgorithm,
};

fn measurement(k: usize) -> Vector2<f64> {
    let t = 0.1 * k as f64;
    Vector2::new(t.sin() + 0.3 * (7.0 * t).cos(), 2.0 * t - (5.0 * t).sin())
}

fn sensor() -> TrackSensor<f64> {
    let h = Matrix2x4::new(1.0, 0.2, 0.0, 0.1, 0.0, 1.0, 0.3, 0.0);
    LinearSensor::new(h, Matrix2::new(0.5, 0.3, 0.3, 0.4)).unwrap()
}

/// Both programs round; conditioning here is below 1e3, and they multiply in different orders.
const ROUNDING: f64 = 1e-12;

#[test]
fn the_kalman_filter_gives_filterpys_figures() {
    const MEAN: [f64; 4] = [-3.7214248100027234, 10.831287901731598, -1.13235431899449, 2.5388789419070195];
    const COVARIANCE: [f64; 16] = [
        0.10746479799205744,
        -0.012551043973838868,
        0.14964278768869052,
        -0.016458372763434717,
        -0.012551043973838862,
        0.0966764108383586,
        -0.061126755221717656,
        0.12701262243589992,
        0.14964278768869047,
        -0.061126755221717656,
        0.383506991119681,
        -0.05268700064795669,
        -0.016458372763434703,
        0.1270126224358999,
        -0.05268700064795668,
        0.352768094544831,
    ];
    const LOG_LIKELIHOOD: f64 = -1.55997868668854;
    let mut filter = KalmanFilter::new(constant_velocity(0.5), track_prior(10.0)).unwrap();
    let mut log_likelihood = 0.0;
    for k in 1..=50 {
        filter.predict(None).unwrap();
        log_likelihood = filter.update(&sensor(), &measurement(k)).unwrap().log_likelihood();
    }
    assert_abs_diff_eq!(*filter.estimate().mean(), Vector4::from(MEAN), epsilon = ROUNDING * 10.0);
    assert_abs_diff_eq!(
        *filter.estimate().covariance(),
        Matrix4::from_row_slice(&COVARIANCE),
        epsilon = ROUNDING
    );
    assert_abs_diff_eq!(log_likelihood, LOG_LIKELIHOOD, epsilon = ROUNDING);
}

#[test]
fn the_imm_gives_filterpys_figures() {
    const MEAN: [f64; 4] = [-0.18937824914262114, 4.294281856442371, -0.5302052853628197, 3.433273452010451];
    const COVARIANCE: [f64; 16] = [
        0.2866571557018623,
        -0.20077901495641298,
        0.842560528450077,
        -0.4719721185139726,
        -0.20077901495641298,
        0.36940511199661746,
        -0.8413576916947497,
        0.9109968695457726,
        0.842560528450077,
        -0.8413576916947497,
        3.9303870352424592,
        -1.669088396195088,
        -0.4719721185139726,
        0.9109968695457724,
        -1.6690883961950878,
        4.041665962459704,
    ];
    const PROBABILITIES: [f64; 2] = [0.4641694228121355, 0.5358305771878646];
    let chain = MarkovChain::new(&[vec![0.95, 0.05], vec![0.1, 0.9]], &[0.5, 0.5]).unwrap();
    let models = vec![constant_velocity(0.01), constant_velocity(20.0)];
    let mut filter = ImmFilter::new(models, chain, ExtendedKalmanAlgorithm, &track_prior(10.0)).unwrap();
    for k in 1..=20 {
        filter.predict(&None).unwrap();
        filter.update(&sensor(), &measurement(k)).unwrap();
    }
    let estimate = filter.estimate().unwrap();
    assert_abs_diff_eq!(*estimate.mean(), Vector4::from(MEAN), epsilon = ROUNDING * 10.0);
    assert_abs_diff_eq!(
        *estimate.covariance(),
        Matrix4::from_row_slice(&COVARIANCE),
        epsilon = ROUNDING * 10.0
    );
    assert_abs_diff_eq!(filter.model_probabilities()[0], PROBABILITIES[0], epsilon = ROUNDING);
}

/// Range and bearing to a landmark at (5, 3); bearings as plain numbers, as filterpy takes them.
struct Landmark;
impl SensorModel for Landmark {
    type State = Vector2<f64>;
    type Measurement = Vector2<f64>;
    fn expected(&self, state: &Vector2<f64>) -> Vector2<f64> {
        let to = state.local(&Vector2::new(5.0, 3.0));
        Vector2::new(to.norm(), to.y.atan2(to.x))
    }
    fn noise(&self, _: &Vector2<f64>) -> Matrix2<f64> {
        Matrix2::from_diagonal(&Vector2::new(0.01, 0.0004))
    }
}

#[test]
fn the_unscented_filter_gives_filterpys_figures() {
    const MEAN: [f64; 2] = [0.056269455835020805, -0.6906084883184099];
    const COVARIANCE: [f64; 4] =
        [0.008223339116055942, -0.0010836214337463827, -0.001083621433746381, 0.007517872740327376];
    let motion = LinearMotion::stationary(Matrix2::from_diagonal(&Vector2::new(0.02, 0.01))).unwrap();
    let prior = Gaussian::new(Vector2::zeros(), Matrix2::from_diagonal(&Vector2::new(0.3, 0.2))).unwrap();
    let mut filter = GaussianFilter::new(motion, UnscentedKalmanAlgorithm::default(), prior).unwrap();
    for k in 1..=10 {
        filter.predict(&None).unwrap();
        let k = f64::from(k);
        filter.update(&Landmark, &Vector2::new(5.7 + 0.05 * k, 0.55 + 0.01 * k)).unwrap();
    }
    // Sigma points depend on which square root of P is taken once measurements are curved: filterpy's upper factor's rows are our lower
    // factor's columns, so rounding is all that is left.
    assert_abs_diff_eq!(*filter.estimate().mean(), Vector2::from(MEAN), epsilon = ROUNDING);
    assert_abs_diff_eq!(
        *filter.estimate().covariance(),
        Matrix2::from_row_slice(&COVARIANCE),
        epsilon = ROUNDING
    );
}
