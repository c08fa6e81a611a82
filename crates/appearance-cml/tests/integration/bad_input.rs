//! Refused input leaves state and map unchanged.

use crate::common;

use crate::common::{Field, FieldView, known, lap};
use approx::assert_abs_diff_eq;
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use wayfix_appearance_cml::{
    AppearanceLocalizer, AppearanceMapError, LocalizerParams, PoseHypothesis, PoseHypothesisSource,
    PositionFix, StartPosePrior,
};
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, GaussianMixture};

type Localizer = AppearanceLocalizer<FieldView>;

struct Weightless;

impl PoseHypothesisSource for Weightless {
    fn hypotheses(
        &self,
        _: Option<&GaussianMixture<Pose2<f64>>>,
    ) -> Result<Vec<PoseHypothesis>, AppearanceMapError> {
        Ok(vec![PoseHypothesis::new(f64::NAN, known(Pose2::new(0.0, 0.0, 0.0)))])
    }
}

struct MoreThanIndependent;

impl PoseHypothesisSource for MoreThanIndependent {
    fn hypotheses(
        &self,
        _: Option<&GaussianMixture<Pose2<f64>>>,
    ) -> Result<Vec<PoseHypothesis>, AppearanceMapError> {
        let hypothesis = PoseHypothesis::new(0.5, known(Pose2::new(0.0, 0.0, 0.0)));
        Ok(vec![PoseHypothesis { independent: 1.5, ..hypothesis }])
    }
}

struct Singular;

impl PoseHypothesisSource for Singular {
    fn hypotheses(
        &self,
        _: Option<&GaussianMixture<Pose2<f64>>>,
    ) -> Result<Vec<PoseHypothesis>, AppearanceMapError> {
        let flat = Gaussian::from_parts_unchecked(Pose2::new(0.0, 0.0, 0.0), Matrix3::zeros());
        Ok(vec![PoseHypothesis::new(0.5, flat)])
    }
}

fn half_a_lap(rng: &mut ChaCha8Rng) -> (Field, Localizer) {
    let field = Field::new(rng);
    let way = lap(14.0, 8.0, 160);
    let start = StartPosePrior::Known(known(way[0]));
    let mut localizer = Localizer::new(LocalizerParams::default(), start).expect("valid defaults");
    for pair in way[..80].windows(2) {
        localizer.update(field.view(&pair[0], rng)).expect("a good view");
        localizer.predict(&common::between(&pair[0], &pair[1])).expect("finite");
    }
    (field, localizer)
}

#[test]
fn odometry_that_is_not_finite_changes_nothing() {
    let (_, mut localizer) = half_a_lap(&mut ChaCha8Rng::seed_from_u64(1));
    let before = localizer.state().cloned();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for increment in [Pose2::new(bad, 0.0, 0.0), Pose2::new(0.0, bad, 0.0), Pose2::new(0.0, 0.0, bad)] {
            assert!(localizer.predict(&increment).is_err());
        }
    }
    assert!(localizer.predict(&Pose2::new(f64::MAX, f64::MAX, 0.0)).is_err(), "its covariance overflows");
    for covariance in [Matrix3::repeat(f64::NAN), Matrix3::from_diagonal(&Vector3::new(1.0, -1e-3, 1.0))] {
        assert!(localizer.predict_unknown(&covariance).is_err());
    }
    assert_eq!(localizer.state().cloned(), before);
}

#[test]
fn sources_that_fail_change_nothing() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let (field, mut localizer) = half_a_lap(&mut rng);
    let (before, references) = (localizer.state().cloned(), localizer.map().references().clone());
    let here = *localizer.estimate().expect("known").mean();
    let flat = PositionFix { position: Vector2::zeros(), covariance: Matrix2::zeros(), weight: 0.5 };
    let nowhere =
        PositionFix { position: Vector2::repeat(f64::NAN), covariance: Matrix2::identity(), weight: 0.5 };
    let sources: [&dyn PoseHypothesisSource; 5] =
        [&flat, &nowhere, &Weightless, &Singular, &MoreThanIndependent];
    for bad in sources {
        assert!(localizer.update_with(field.view(&here, &mut rng), &[bad]).is_err());
    }
    assert_eq!(localizer.state().cloned(), before);
    assert_eq!(localizer.map().references(), &references, "the learned map is never lost");
}

#[test]
fn a_fix_helps_where_nothing_is_known() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let field = Field::new(&mut rng);
    let mut localizer =
        Localizer::new(LocalizerParams::default(), StartPosePrior::Anywhere).expect("valid defaults");
    let pose = Pose2::new(3.0, 4.0, 0.0);
    let nothing = localizer.update(field.view(&pose, &mut rng)).expect("a good view");
    assert_eq!((nothing.estimate, nothing.n_detections), (None, 0), "no references, no idea");
    let fix =
        PositionFix { position: Vector2::new(3.1, 4.1), covariance: Matrix2::identity() * 0.04, weight: 0.9 };
    let outcome = localizer.update_with(field.view(&pose, &mut rng), &[&fix]).expect("a good fix");
    let estimate = outcome.estimate.expect("the fix says where");
    assert_abs_diff_eq!(estimate.mean().translation, Vector2::new(3.1, 4.1), epsilon = 1e-9);
}

#[test]
fn a_robot_with_an_empty_map_starts_by_gps() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let field = Field::new(&mut rng);
    let mut localizer =
        Localizer::new(LocalizerParams::default(), StartPosePrior::Anywhere).expect("valid defaults");
    for k in 0..20 {
        let pose = Pose2::new(3.0 + 0.25 * f64::from(k), 4.0, 0.0);
        let fix =
            PositionFix { position: pose.translation, covariance: Matrix2::identity() * 4.0, weight: 0.9 };
        localizer.update_with(field.view(&pose, &mut rng), &[&fix]).expect("a good fix");
        let estimate = localizer.estimate().expect("the fix says where");
        assert_abs_diff_eq!(estimate.mean().translation, pose.translation, epsilon = 0.5);
        localizer.predict(&Pose2::new(0.25, 0.0, 0.0)).expect("finite");
    }
    assert!(localizer.map().len() > 5, "it learns");
}

#[test]
fn invalid_start_or_parameters_are_refused() {
    let flat = Gaussian::from_parts_unchecked(Pose2::new(0.0, 0.0, 0.0), Matrix3::zeros());
    assert!(Localizer::new(LocalizerParams::default(), StartPosePrior::Known(flat)).is_err());
    let mut params = LocalizerParams::default();
    params.map.weight_learning_rate = f64::NAN;
    assert!(matches!(
        Localizer::new(params, StartPosePrior::Anywhere),
        Err(AppearanceMapError::Parameter { what: "learning rate", .. })
    ));
}
