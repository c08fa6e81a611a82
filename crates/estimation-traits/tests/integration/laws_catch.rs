//! Types that are wrong on purpose, two of them as published: each suite says so, and says which law.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail like tests")]

use nalgebra::{Const, Matrix1, Matrix2, Matrix3, Vector1, Vector2, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use wayfix_estimation_traits::{
    Angle, LieGroup, LikelihoodModel, LogWeight, Manifold, MotionModel, Pose2, SampleMotion, SensorModel,
    laws, wrap_angle,
};

const SEED: u64 = 20_261_121;

/// An angle that wraps in `retract` but not in `local`, or nowhere at all.
#[derive(Clone)]
struct Careless {
    radians: f64,
    retract_wraps: bool,
}

impl Manifold for Careless {
    type Scalar = f64;
    type Dim = Const<1>;
    fn dim(&self) -> Const<1> {
        Const
    }
    fn retract(&self, delta: &Vector1<f64>) -> Self {
        let sum = self.radians + delta.x;
        Self { radians: if self.retract_wraps { wrap_angle(sum) } else { sum }, ..*self }
    }
    fn local(&self, other: &Self) -> Vector1<f64> {
        Vector1::new(other.radians - self.radians)
    }
}

#[test]
fn an_angle_that_does_not_wrap() {
    let near_the_wrap = |retract_wraps| [3.1, -3.1].map(|radians| Careless { radians, retract_wraps });
    let violation = laws::manifold(&near_the_wrap(true)).unwrap_err();
    assert!(violation.law.contains("law 2"), "{violation}");
    // A number on the line is a manifold too; only its period tells.
    laws::manifold(&near_the_wrap(false)).unwrap();
    assert!(laws::periodic(&near_the_wrap(false), 0, std::f64::consts::TAU).is_err());
}

/// SE(2) as factrs 0.3.0 has it: the small-angle series for every angle below a threshold, negative ones included.
#[derive(Clone)]
struct OneSided(Pose2<f64>);

impl Manifold for OneSided {
    type Scalar = f64;
    type Dim = Const<3>;
    fn dim(&self) -> Const<3> {
        Const
    }
    fn retract(&self, delta: &Vector3<f64>) -> Self {
        Self(self.0.retract(delta))
    }
    fn local(&self, other: &Self) -> Vector3<f64> {
        self.0.local(&other.0)
    }
}

impl LieGroup for OneSided {
    fn identity() -> Self {
        Self(Pose2::identity())
    }
    fn compose(&self, other: &Self) -> Self {
        Self(self.0.compose(&other.0))
    }
    fn inverse(&self) -> Self {
        Self(self.0.inverse())
    }
    fn exp(tangent: &Vector3<f64>) -> Self {
        if tangent.z < 1e-6 {
            let z = tangent.z;
            Self(Pose2::new(tangent.x - 0.5 * z * tangent.y, tangent.y + 0.5 * z * tangent.x, z))
        } else {
            Self(Pose2::exp(tangent))
        }
    }
    fn log(&self) -> Vector3<f64> {
        self.0.log()
    }
    fn adjoint(&self) -> Matrix3<f64> {
        self.0.adjoint()
    }
}

#[test]
fn an_exponential_that_is_wrong_for_negative_angles() {
    let points = [OneSided::identity(), OneSided(Pose2::new(1.0, -2.0, 3.0))];
    laws::manifold(&points).unwrap();
    let violation = laws::lie_group(&points).unwrap_err();
    assert!(violation.law.contains("exp(sξ) exp(tξ)"), "{violation}");
    // The suite does not merely dislike the type: the same poses with the right exponential pass.
    laws::lie_group(&points.map(|point| point.0)).unwrap();
}

/// A robot that drives `control` metres ahead; with the sign of a derivative wrong, or a noise that is none.
struct Drive {
    jacobian_sign: f64,
    correlation: f64,
}

impl MotionModel for Drive {
    type State = Pose2<f64>;
    type Control = f64;
    fn propagate(&self, state: &Pose2<f64>, control: &f64) -> Pose2<f64> {
        state.retract(&Vector3::new(*control, 0.0, 0.1))
    }
    fn jacobian(&self, _: &Pose2<f64>, control: &f64) -> Matrix3<f64> {
        // In the body frame after turning by 0.1.
        let (sin, cos) = 0.1_f64.sin_cos();
        let turn = Matrix3::new(cos, sin, 0.0, -sin, cos, 0.0, 0.0, 0.0, 1.0);
        let shear = self.jacobian_sign * control;
        turn * Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, shear, 0.0, 0.0, 1.0)
    }
    fn noise(&self, _: &Pose2<f64>, _: &f64) -> Matrix3<f64> {
        let mut noise = Matrix3::identity() * 1e-4;
        noise[(0, 1)] = self.correlation * 1e-4;
        noise[(1, 0)] = self.correlation * 1e-4;
        noise
    }
}

const RIGHT: Drive = Drive { jacobian_sign: 1.0, correlation: 0.5 };
const CONTROLS: [f64; 2] = [1.5, -0.5];

fn starts() -> Vec<(Pose2<f64>, &'static f64)> {
    let poses = [Pose2::new(0.0, 0.0, 0.0), Pose2::new(3.0, -4.0, 3.1)];
    poses.into_iter().flat_map(|pose| CONTROLS.iter().map(move |control| (pose, control))).collect()
}

#[test]
fn a_jacobian_with_a_sign_error_and_an_indefinite_noise() {
    laws::motion(&RIGHT, &starts()).unwrap();
    let violation = laws::motion(&Drive { jacobian_sign: -1.0, ..RIGHT }, &starts()).unwrap_err();
    assert!(violation.law.contains("jacobian"), "{violation}");
    let violation = laws::motion(&Drive { correlation: 2.0, ..RIGHT }, &starts()).unwrap_err();
    assert!(violation.law.contains("semidefinite"), "{violation}");
}

/// Draws from `Drive` with a standard deviation `scale` times the right one.
struct Draws {
    scale: f64,
}

impl SampleMotion for Draws {
    type State = Pose2<f64>;
    type Control = f64;
    fn sampler<R: rand::Rng + ?Sized>(&self, control: &f64) -> impl Fn(&Pose2<f64>, &mut R) -> Pose2<f64> {
        move |state, rng| {
            let factor = RIGHT.noise(state, control).cholesky().unwrap().l() * self.scale;
            let normal = Vector3::from_fn(|_, _| StandardNormal.sample(rng));
            RIGHT.propagate(state, control).retract(&(factor * normal))
        }
    }
}

#[test]
fn samples_that_are_too_narrow() {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    laws::sample_motion(&Draws { scale: 1.0 }, &RIGHT, &starts(), 10_000, &mut rng).unwrap();
    // 10 % in sigma is 19 % in variance, against a bound of 5 sqrt(2/10000) = 7 %.
    assert!(laws::sample_motion(&Draws { scale: 0.9 }, &RIGHT, &starts(), 10_000, &mut rng).is_err());
}

/// The bearing to the origin; `sign` -1 is the classic mistake.
struct Bearing {
    sign: f64,
    variance: f64,
}

impl SensorModel for Bearing {
    type State = Vector2<f64>;
    type Measurement = Angle<f64>;
    fn expected(&self, state: &Vector2<f64>) -> Angle<f64> {
        Angle::new((-state.y).atan2(-state.x))
    }
    fn jacobian(&self, state: &Vector2<f64>) -> nalgebra::RowVector2<f64> {
        nalgebra::RowVector2::new(-state.y, state.x) * (self.sign / state.norm_squared())
    }
    fn noise(&self, _: &Vector2<f64>) -> Matrix1<f64> {
        Matrix1::new(self.variance)
    }
}

#[test]
fn a_sensor_with_a_sign_error_or_without_noise() {
    // The second is where the bearing jumps from π to -π.
    let states = [Vector2::new(1.0, 2.0), Vector2::new(3.0, 0.0), Vector2::new(-5.0, -1e-3)];
    laws::sensor(&Bearing { sign: 1.0, variance: 0.01 }, &states).unwrap();
    assert!(laws::sensor(&Bearing { sign: -1.0, variance: 0.01 }, &states).is_err());
    assert!(laws::sensor(&Bearing { sign: 1.0, variance: 0.0 }, &states).is_err());
}

/// The log-likelihood of a range, correct or with NaN at the landmark.
struct Likely {
    nan_at_zero: bool,
}

impl LikelihoodModel for Likely {
    type State = f64;
    type Measurement = f64;
    fn log_likelihood(&self, measurement: &f64) -> impl Fn(&f64) -> LogWeight {
        move |state| if self.nan_at_zero && *state == 0.0 { f64::NAN } else { -(state - measurement).powi(2) }
    }
}

#[test]
fn a_likelihood_that_is_nan_or_peaks_elsewhere() {
    let others = [0.0, 2.5, -1e30];
    laws::likelihood(&Likely { nan_at_zero: false }, &2.0, &2.0, &others).unwrap();
    assert!(laws::likelihood(&Likely { nan_at_zero: true }, &2.0, &2.0, &others).is_err());
    assert!(laws::likelihood(&Likely { nan_at_zero: false }, &2.0, &4.0, &others).is_err());
}

/// A scalar Kalman filter, and two of its mistakes: kfilter 0.5.1 computes the gain and drops the result; another checks too late.
#[derive(Clone)]
struct Scalar {
    mean: f64,
    variance: f64,
    applies_gain: bool,
    checks_first: bool,
}

impl Scalar {
    fn predict(&mut self, control: f64) -> bool {
        if control.is_finite() {
            self.mean += control;
            self.variance += 0.1;
        }
        control.is_finite()
    }
    fn update(&mut self, measurement: f64) -> bool {
        if self.checks_first && !measurement.is_finite() {
            return false;
        }
        let gain = self.variance / (self.variance + 0.01);
        self.variance *= 1.0 - gain;
        if self.applies_gain && measurement.is_finite() {
            self.mean += gain * (measurement - self.mean);
        }
        measurement.is_finite()
    }
}

#[test]
fn law_suite_catches_a_frozen_filter_and_a_dirty_refusal() {
    let honest = Scalar { mean: 0.0, variance: 1.0, applies_gain: true, checks_first: true };
    let good: laws::FilterLawCall<'_, Scalar> = &|filter| filter.update(5.0);
    let trial = laws::FilterLawTrial {
        estimate: &|filter: &Scalar| (filter.mean, filter.variance),
        error: &|estimate: &(f64, f64)| (estimate.0 - 5.0).abs(),
        bound: 0.1,
        accepted: &[good; 3],
        refused: &[&|filter| filter.update(f64::NAN), &|filter| filter.update(f64::INFINITY), &|filter| {
            filter.predict(f64::NAN)
        }],
    };
    laws::filter(&honest, &trial).unwrap();
    let violation = laws::filter(&Scalar { applies_gain: false, ..honest.clone() }, &trial).unwrap_err();
    assert!(violation.law.contains("moves to the truth"), "{violation}");
    let violation = laws::filter(&Scalar { checks_first: false, ..honest }, &trial).unwrap_err();
    assert!(violation.law.contains("as it was"), "{violation}");
}

/// A chart Jacobian that forgets the turn between the frames.
#[derive(Clone)]
struct Forgetful(Pose2<f64>);

impl Manifold for Forgetful {
    type Scalar = f64;
    type Dim = Const<3>;
    fn dim(&self) -> Const<3> {
        Const
    }
    fn retract(&self, delta: &Vector3<f64>) -> Self {
        Self(self.0.retract(delta))
    }
    fn local(&self, other: &Self) -> Vector3<f64> {
        self.0.local(&other.0)
    }
    fn chart_jacobian(&self, _: &Self) -> Matrix3<f64> {
        Matrix2::identity().to_homogeneous()
    }
}

#[test]
fn a_chart_jacobian_without_the_turn() {
    let violation = laws::manifold(&[Forgetful(Pose2::new(1.0, 2.0, 3.0))]).unwrap_err();
    assert!(violation.law.contains("law 5"), "{violation}");
}
