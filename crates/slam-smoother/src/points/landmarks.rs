use std::collections::BTreeMap;

use nalgebra::{Matrix2, Vector2};
use wayfix_smoother::VariableId;

use super::{MountedRangeBearing, PointSmoother, residuals::SamePoint, smoother::ONLINE};
use crate::{ROBUST_KERNEL, SlamSmootherError};

/// Two landmarks that are one are together to within this, m.
const SAME: f64 = 1e-3;

impl PointSmoother {
    /// Landmarks, by identity.
    pub fn landmarks(&self) -> BTreeMap<u32, Vector2<f64>> {
        let place = |(id, variable): (&u32, &VariableId<Vector2<f64>>)| {
            Some((*id, *self.graph.value(*variable).ok()?))
        };
        self.landmarks.iter().filter_map(place).collect()
    }

    /// Whether a landmark or anchor is in the map.
    pub fn contains(&self, landmark: u32) -> bool {
        self.landmarks.contains_key(&landmark)
    }

    /// Holds a landmark at a place that is known from now on; an anchor stays where it is.
    ///
    /// # Errors
    /// Never while the smoother is whole.
    pub fn add_anchor(&mut self, landmark: u32, place: Vector2<f64>) -> Result<(), SlamSmootherError> {
        if !self.anchors.insert(landmark) {
            return Ok(());
        }
        let id = *self.landmarks.entry(landmark).or_insert_with(|| self.graph.add_variable(place));
        self.graph.set_value(id, place)?;
        Ok(self.graph.fix(id)?)
    }

    /// Takes a landmark back, with its detections in the window.
    ///
    /// # Errors
    /// [`SlamSmootherError::Smoother`] when what earlier poses knew of it cannot be marginalized.
    pub fn remove(&mut self, landmark: u32) -> Result<(), SlamSmootherError> {
        if let Some(id) = self.landmarks.get(&landmark).copied() {
            self.graph.remove_variables(&[id.index()])?;
            self.start.take_if(|start| start.names(&[id.index()]));
            self.landmarks.remove(&landmark);
            self.anchors.remove(&landmark);
        }
        Ok(())
    }

    /// Says that two landmarks are one: a batch takes the detections of both for those of one; in a window the second is marginalized.
    ///
    /// # Errors
    /// [`SlamSmootherError::Smoother`] when they cannot be joined.
    pub fn merge(&mut self, kept: u32, removed: u32) -> Result<(), SlamSmootherError> {
        let (Some(a), Some(b)) = (self.landmarks.get(&kept).copied(), self.landmarks.get(&removed).copied())
        else {
            return Ok(());
        };
        let is_in_start = self.start.as_ref().is_some_and(|start| start.names(&[b.index()]));
        if self.params.lag.is_none() && !is_in_start {
            self.reassign_detections(b, a)?;
            self.graph.remove_variables(&[b.index()])?;
        } else {
            self.graph.add(SamePoint, (a, b), Matrix2::identity() * SAME.powi(-2))?;
            self.graph.optimize(&ONLINE)?;
            self.marginalize(&[b.index()])?;
        }
        self.landmarks.remove(&removed);
        Ok(())
    }

    /// Adds each detection of a landmark as one of another.
    fn reassign_detections(
        &mut self,
        from: VariableId<Vector2<f64>>,
        to: VariableId<Vector2<f64>>,
    ) -> Result<(), SlamSmootherError> {
        let poses: BTreeMap<_, _> =
            self.window.iter().map(|frame| (frame.pose.index(), frame.pose)).collect();
        let residuals = self.graph.residuals::<MountedRangeBearing>();
        let of_landmark = residuals.filter(|(_, _, named, _)| named[1] == from.index());
        let detections: Vec<_> = of_landmark
            .filter_map(|(_, seen, named, information)| Some((*seen, *poses.get(&named[0])?, *information)))
            .collect();
        for (detection, pose, information) in detections {
            let added = self.graph.add(detection, (pose, to, self.scale), information)?;
            self.graph.set_kernel(added, ROBUST_KERNEL)?;
        }
        Ok(())
    }
}
