use std::collections::BTreeMap;

use nalgebra::Vector2;
use wayfix_estimation_traits::Pose2;

use super::{align, rms_distance};

/// Association of estimated landmarks with true ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LandmarkCorrespondence {
    /// Both carry the same identities.
    ById,
    /// By distance, because the filter numbers its landmarks itself: each estimate is compared with the nearest true landmark, without alignment or
    /// after the alignment by nearest partners.
    Nearest,
}

/// RMS landmark error in metres, without alignment and after a rigid alignment; `None` without pairs.
///
/// Nearest partners are searched again after every alignment, until the error stops decreasing (iterated closest points [Besl & McKay 1992]). The
/// search starts from the map itself and from `of_path`, the motion that aligns the path: a rotated map would otherwise have wrong pairs.
pub fn landmark_errors(
    estimated: &BTreeMap<u32, Vector2<f64>>,
    truth: &BTreeMap<u32, Vector2<f64>>,
    correspondence: LandmarkCorrespondence,
    of_path: &Pose2<f64>,
) -> Option<(f64, f64)> {
    let pairs = |motion: &Pose2<f64>| -> Vec<(Vector2<f64>, Vector2<f64>)> {
        let partner = |id: &u32, position: &Vector2<f64>| match correspondence {
            LandmarkCorrespondence::ById => truth.get(id).copied(),
            LandmarkCorrespondence::Nearest => nearest(&motion.transform(position), truth),
        };
        estimated.iter().filter_map(|(id, at)| Some((*at, partner(id, at)?))).collect()
    };
    let identity = Pose2::new(0.0, 0.0, 0.0);
    let as_it_stands = pairs(&identity);
    let rmse = rms_distance(as_it_stands.iter().copied(), &identity)?;
    let aligned_from = |start: &Pose2<f64>| {
        let (mut pairs_now, mut least) = (pairs(start), f64::INFINITY);
        for _ in 0..MOST_ITERATIONS {
            let motion = align(pairs_now.iter().copied());
            let error = rms_distance(pairs_now.iter().copied(), &motion)?;
            if error >= least {
                break;
            }
            (pairs_now, least) = (pairs(&motion), error);
        }
        Some(least)
    };
    Some((rmse, aligned_from(&identity)?.min(aligned_from(of_path)?)))
}

/// The error falls with every iteration, in practice for a handful of them.
const MOST_ITERATIONS: usize = 100;

fn nearest(position: &Vector2<f64>, truth: &BTreeMap<u32, Vector2<f64>>) -> Option<Vector2<f64>> {
    let distance = |landmark: &Vector2<f64>| (landmark - position).norm_squared();
    truth.values().copied().min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;
    use wayfix_estimation_traits::LieGroup;

    use super::*;

    const SOMEWHAT: f64 = 0.05;

    fn map(landmarks: &[(u32, f64, f64)]) -> BTreeMap<u32, Vector2<f64>> {
        landmarks.iter().map(|&(id, x, y)| (id, Vector2::new(x, y))).collect()
    }

    #[test]
    fn identities_pair_landmarks_and_skip_unpaired_ones() {
        let truth = map(&[(1, 0.0, 0.0), (2, 10.0, 0.0), (3, 0.0, 10.0)]);
        let estimated = map(&[(1, 0.0, 0.3), (2, 10.0, 0.4), (9, 50.0, 50.0)]);
        let (rmse, aligned) =
            landmark_errors(&estimated, &truth, LandmarkCorrespondence::ById, &Pose2::new(0.0, 0.0, 0.0))
                .unwrap();
        assert_abs_diff_eq!(rmse, 0.125_f64.sqrt(), epsilon = 1e-12); // (0.3² + 0.4²) / 2
        // Two points lie on a line of their own length; a rigid motion leaves the difference in length, half at each end.
        assert_abs_diff_eq!(aligned, 0.5 * (10.0_f64.hypot(0.1) - 10.0), epsilon = 1e-12);
        let swapped = map(&[(1, 10.0, 0.0), (2, 0.0, 0.0)]);
        assert!(
            (landmark_errors(&swapped, &truth, LandmarkCorrespondence::ById, &Pose2::new(0.0, 0.0, 0.0))
                .unwrap()
                .0
                - 10.0)
                .abs()
                < 1e-12
        );
    }

    #[test]
    fn nearest_does_not_care_for_names_and_counts_a_duplicate_twice() {
        let truth = map(&[(1, 0.0, 0.0), (2, 10.0, 0.0)]);
        let swapped = map(&[(1, 10.0, 0.0), (2, 0.0, 0.0)]);
        assert_eq!(
            landmark_errors(&swapped, &truth, LandmarkCorrespondence::Nearest, &Pose2::new(0.0, 0.0, 0.0))
                .unwrap()
                .0,
            0.0
        );
        let doubled = map(&[(0, 0.0, 0.0), (1, 0.0, 1.0), (2, 10.0, 0.0)]);
        let (rmse, _) =
            landmark_errors(&doubled, &truth, LandmarkCorrespondence::Nearest, &Pose2::new(0.0, 0.0, 0.0))
                .unwrap();
        assert_abs_diff_eq!(rmse, (1.0_f64 / 3.0).sqrt(), epsilon = 1e-12);
    }

    #[test]
    fn a_map_that_is_turned_as_a_whole_finds_its_partners() {
        let truth = map(&[(1, 0.0, 0.0), (2, 10.0, 0.0), (3, 10.0, 1.5), (4, 0.0, 8.0), (5, 10.0, -1.5)]);
        let turn = Pose2::new(0.2, -0.1, 0.15); // 1.5 m at the far landmarks, equal to their separation
        let turned = truth.iter().map(|(id, at)| (id + 10, turn.transform(at))).collect();
        let of_path = turn.inverse().compose(&Pose2::new(SOMEWHAT, -SOMEWHAT, SOMEWHAT));
        let (rmse, aligned) =
            landmark_errors(&turned, &truth, LandmarkCorrespondence::Nearest, &of_path).unwrap();
        assert!(rmse > 0.1 && aligned < 1e-9, "{rmse} {aligned}");
    }

    #[test]
    fn without_pairs_there_is_no_error() {
        let (none, some) = (map(&[]), map(&[(1, 0.0, 0.0)]));
        for correspondence in [LandmarkCorrespondence::ById, LandmarkCorrespondence::Nearest] {
            assert_eq!(landmark_errors(&none, &some, correspondence, &Pose2::new(0.0, 0.0, 0.0)), None);
            assert_eq!(landmark_errors(&some, &none, correspondence, &Pose2::new(0.0, 0.0, 0.0)), None);
        }
    }
}
