use std::collections::BTreeMap;

use nalgebra::Vector2;
use wayfix_estimation_traits::Pose2;

use super::{align, rms_distance};

/// How estimated landmarks find their true partners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Correspondence {
    /// Both carry the same identities.
    ById,
    /// The filter gave its own identities: each estimate is compared with the nearest true landmark.
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
