use std::collections::BTreeMap;

use nalgebra::Vector2;
use wayfix_estimation_traits::Pose2;

use super::{align, rms_distance};

/// How estimated landmarks find their true partners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Correspondence {
    /// Both carry the same identities.
    ById,
    /// The filter gave its own identities: each estimate is compared with the true landmark that is nearest before any alignment.
    Nearest,
}

/// Root mean square landmark error in metres, as it stands and after a rigid alignment of its own; `None` without pairs.
pub fn landmark_errors(
    estimated: &BTreeMap<u32, Vector2<f64>>,
    truth: &BTreeMap<u32, Vector2<f64>>,
    correspondence: Correspondence,
) -> Option<(f64, f64)> {
    let partner = |id: &u32, position: &Vector2<f64>| match correspondence {
        Correspondence::ById => truth.get(id).copied(),
        Correspondence::Nearest => truth
            .values()
            .copied()
            .min_by(|a, b| (a - position).norm_squared().total_cmp(&(b - position).norm_squared())),
    };
    let pairs: Vec<_> = estimated.iter().filter_map(|(id, at)| Some((*at, partner(id, at)?))).collect();
    let pairs = pairs.iter().copied();
    Some((
        rms_distance(pairs.clone(), &Pose2::new(0.0, 0.0, 0.0))?,
        rms_distance(pairs.clone(), &align(pairs))?,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(landmarks: &[(u32, f64, f64)]) -> BTreeMap<u32, Vector2<f64>> {
        landmarks.iter().map(|&(id, x, y)| (id, Vector2::new(x, y))).collect()
    }

    #[test]
    fn identities_pair_what_they_name_and_leave_out_what_has_no_partner() {
        let truth = map(&[(1, 0.0, 0.0), (2, 10.0, 0.0), (3, 0.0, 10.0)]);
        let estimated = map(&[(1, 0.0, 0.3), (2, 10.0, 0.4), (9, 50.0, 50.0)]);
        let (rmse, aligned) = landmark_errors(&estimated, &truth, Correspondence::ById).unwrap();
        assert!((rmse - 0.125_f64.sqrt()).abs() < 1e-12); // (0.3² + 0.4²) / 2
        // Two points lie on a line of their own length; what a rigid motion cannot mend is the difference in length, half at each end.
        assert!((aligned - 0.5 * (10.0_f64.hypot(0.1) - 10.0)).abs() < 1e-12);
        let swapped = map(&[(1, 10.0, 0.0), (2, 0.0, 0.0)]);
        assert!((landmark_errors(&swapped, &truth, Correspondence::ById).unwrap().0 - 10.0).abs() < 1e-12);
    }

    #[test]
    fn nearest_does_not_care_for_names_and_counts_a_duplicate_twice() {
        let truth = map(&[(1, 0.0, 0.0), (2, 10.0, 0.0)]);
        let swapped = map(&[(1, 10.0, 0.0), (2, 0.0, 0.0)]);
        assert_eq!(landmark_errors(&swapped, &truth, Correspondence::Nearest).unwrap().0, 0.0);
        let doubled = map(&[(0, 0.0, 0.0), (1, 0.0, 1.0), (2, 10.0, 0.0)]);
        let (rmse, _) = landmark_errors(&doubled, &truth, Correspondence::Nearest).unwrap();
        assert!((rmse - (1.0_f64 / 3.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn without_pairs_there_is_no_error() {
        let (none, some) = (map(&[]), map(&[(1, 0.0, 0.0)]));
        for correspondence in [Correspondence::ById, Correspondence::Nearest] {
            assert_eq!(landmark_errors(&none, &some, correspondence), None);
            assert_eq!(landmark_errors(&some, &none, correspondence), None);
        }
    }
}
