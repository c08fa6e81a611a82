use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Matrix2, Vector1, Vector2};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_smoother::{Residual, ResidualId, VariableId};

use super::{MountedRangeBearing, PointSmoother};
use crate::{ROBUST_KERNEL, SlamSmootherError};

/// A landmark at its present place.
struct Landmark {
    variable: VariableId<Vector2<f64>>,
    place: Vector2<f64>,
}

/// A detection in the window, with the number of its landmark in a list.
struct Paired {
    id: ResidualId,
    seen: MountedRangeBearing,
    information: Matrix2<f64>,
    landmark: usize,
}

/// A detection of a scan and a landmark that it agrees with, by their numbers in lists.
struct Candidate {
    squared_distance: f64,
    detection: usize,
    landmark: usize,
}

impl PointSmoother {
    /// Pairs the detections of the window anew at the smoothed poses and places; how many have another landmark.
    ///
    /// With poses and places held, a scan takes other pairings if no detection has a larger $`r^T Ω r`$ then: this half of a coordinate descent lowers
    /// the cost of the window, as its solution with held pairings does. A landmark takes one detection of a scan. A landmark without evidence
    /// any more leaves the map.
    pub(super) fn pair_anew(&mut self) -> Result<usize, SlamSmootherError> {
        let (landmarks, scans) = (self.landmark_list()?, self.scans());
        let scale = *self.graph.value(self.scale)?;
        let poses: Vec<_> = self.window.iter().map(|frame| frame.pose).collect();
        let (mut n_changed, mut left) = (0, BTreeSet::new());
        for pose in poses {
            let Some(scan) = scans.get(&pose.index()) else { continue };
            let chosen = best_pairing(self.graph.value(pose)?, &scale, scan, &landmarks);
            for (Paired { id, seen, information, landmark }, chosen) in scan.iter().zip(chosen) {
                if chosen == *landmark {
                    continue;
                }
                self.graph.remove(*id)?;
                let variables = (pose, landmarks[chosen].variable, self.scale);
                let added = self.graph.add(*seen, variables, *information)?;
                self.graph.set_kernel(added, ROBUST_KERNEL)?;
                left.insert(landmarks[*landmark].variable.index());
                n_changed += 1;
            }
        }
        left.retain(|variable| self.graph.is_without_residual(*variable));
        self.graph.remove_variables(&left.iter().copied().collect::<Vec<_>>())?;
        self.landmarks.retain(|_, landmark| !left.contains(&landmark.index()));
        Ok(n_changed)
    }

    fn landmark_list(&self) -> Result<Vec<Landmark>, SlamSmootherError> {
        let landmark = |variable: &VariableId<_>| {
            Ok(Landmark { variable: *variable, place: *self.graph.value(*variable)? })
        };
        self.landmarks.values().map(landmark).collect()
    }

    /// The detections in the window, by the numbers of the variables of their poses.
    fn scans(&self) -> BTreeMap<usize, Vec<Paired>> {
        let numbers: BTreeMap<usize, usize> = self
            .landmarks
            .values()
            .enumerate()
            .map(|(number, variable)| (variable.index(), number))
            .collect();
        let mut scans = BTreeMap::<_, Vec<_>>::new();
        for (id, seen, named, information) in self.graph.residuals::<MountedRangeBearing>() {
            let Some(landmark) = numbers.get(&named[1]).copied() else { continue };
            let paired = Paired { id, seen: *seen, information: *information, landmark };
            scans.entry(named[0]).or_default().push(paired);
        }
        scans
    }
}

/// The landmark of each detection of a scan: the pairs that agree best first, each landmark once. As before if a detection would go without.
fn best_pairing(
    robot: &Pose2<f64>,
    log_scale: &Vector1<f64>,
    scan: &[Paired],
    landmarks: &[Landmark],
) -> Vec<usize> {
    let mut candidates = Vec::new();
    for (detection, paired) in scan.iter().enumerate() {
        candidates.extend(candidates_of(detection, paired, robot, log_scale, landmarks));
    }
    candidates.sort_by(|a, b| a.squared_distance.total_cmp(&b.squared_distance));
    let (mut chosen, mut taken) = (vec![None; scan.len()], BTreeSet::new());
    for Candidate { detection, landmark, .. } in candidates {
        if chosen[detection].is_none() && taken.insert(landmark) {
            chosen[detection] = Some(landmark);
        }
    }
    let all: Option<_> = chosen.into_iter().collect();
    all.unwrap_or_else(|| scan.iter().map(|paired| paired.landmark).collect())
}

/// The landmark of a detection, and those that it agrees with better.
fn candidates_of(
    detection: usize,
    Paired { seen, information, landmark: present, .. }: &Paired,
    robot: &Pose2<f64>,
    log_scale: &Vector1<f64>,
    landmarks: &[Landmark],
) -> Vec<Candidate> {
    let squared_distance = |landmark: usize| {
        let residual = seen.value((robot, &landmarks[landmark].place, log_scale));
        residual.dot(&(information * residual))
    };
    let largest = squared_distance(*present);
    let mut candidates = vec![Candidate { squared_distance: largest, detection, landmark: *present }];
    // Whatever the bearing, r^T Ω r is not below what the range alone adds.
    let of_range = information.m11 - information.m12 * information.m21 / information.m22;
    let (sensor, scale) = (robot.compose(&seen.mount).translation, log_scale.x.exp());
    for (landmark, Landmark { place, .. }) in landmarks.iter().enumerate() {
        let by_range = of_range * (scale * (place - sensor).norm() - seen.range).powi(2);
        if landmark == *present || by_range >= largest {
            continue;
        }
        let squared_distance = squared_distance(landmark);
        if squared_distance < largest {
            candidates.push(Candidate { squared_distance, detection, landmark });
        }
    }
    candidates
}
