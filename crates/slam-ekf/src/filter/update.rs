use std::collections::BTreeSet;

use nalgebra::{DMatrix, DVector, DefaultAllocator, Vector3};
use wayfix_estimation_traits::{Manifold, Tangent};

use super::{EkfSlam, PredictedSighting};
use crate::{
    Association, DataAssociation, Innovation, LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, Observation, Outcome,
    SlamAlloc, SlamError, StepReport, covariance::SparseJacobian,
};

/// An observation that passed the gate, with what the correction needs of it.
struct Accepted<M: LandmarkModel>
where
    DefaultAllocator: SlamAlloc<LandmarkDim<M>, MeasurementDim<M>>,
{
    sighting: PredictedSighting<M>,
    innovation: Innovation<M::Measurement>,
}

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Corrects robot and map with everything one look of the sensor saw.
    ///
    /// Observations are associated at the predicted state, gated one by one, and those that pass correct together; then new
    /// landmarks start. Each observation's fate is in the report, in the order they came; one that cannot be used (not finite, twice the
    /// same landmark, outside the gate) leaves the others alone.
    ///
    /// # Errors
    /// When the joint innovation covariance is not positive definite; nothing has changed then.
    pub fn update(
        &mut self,
        observations: &[Observation<M::Measurement>],
        association: &mut impl DataAssociation<M>,
    ) -> Result<StepReport<M::Measurement>, SlamError> {
        let usable: Vec<usize> =
            (0..observations.len()).filter(|&i| self.model.is_usable(&observations[i].measurement)).collect();
        let candidates: Vec<_> = usable.iter().map(|&i| observations[i].clone()).collect();
        let associations = association.associate(self, &candidates);

        let mut outcomes = vec![Outcome::Unusable; observations.len()];
        let (mut accepted, mut new, mut taken) = (Vec::new(), Vec::new(), BTreeSet::new());
        for (&i, association) in usable.iter().zip(associations) {
            let measurement = &observations[i].measurement;
            outcomes[i] = match association {
                Association::Matched(id) | Association::New(id) if !taken.insert(id) => Outcome::Duplicate { landmark: id },
                Association::Matched(id) => self.gate(id, measurement, &mut accepted),
                Association::New(id) => {
                    new.push((i, id));
                    Outcome::Initialized { landmark: id }
                }
                Association::Tentative => Outcome::Tentative,
                Association::Ambiguous => Outcome::Ambiguous,
                Association::Unlabelled => Outcome::Unlabelled,
            };
        }

        self.correct(&accepted)?;
        for (i, id) in new {
            if self.initialize(id, &observations[i].measurement).is_err() {
                outcomes[i] = Outcome::Unusable;
            }
        }
        Ok(StepReport { outcomes })
    }

    /// Individual compatibility: the NIS against the chi-squared quantile.
    fn gate(
        &self,
        landmark: LandmarkId,
        measurement: &M::Measurement,
        accepted: &mut Vec<Accepted<M>>,
    ) -> Outcome<M::Measurement> {
        let Some(sighting) = self.predicted_sighting(landmark) else {
            return Outcome::Unusable;
        };
        let innovation = sighting.innovation(measurement);
        let threshold = self.gates.threshold(innovation.residual.len());
        if innovation.nis <= threshold {
            accepted.push(Accepted { sighting, innovation: innovation.clone() });
            Outcome::Accepted { landmark, innovation }
        } else {
            Outcome::Gated { landmark, innovation, threshold }
        }
    }

    /// All accepted observations at once: one joint linear correction, then the means step.
    fn correct(&mut self, accepted: &[Accepted<M>]) -> Result<(), SlamError> {
        let (jacobian, noise, residual) = stack(accepted);
        if jacobian.nrows() == 0 {
            return Ok(());
        }
        let step = self.covariance.correct(&jacobian, &noise, &residual).ok_or_else(|| SlamError::NotACovariance {
            what: "joint innovation covariance",
            value: noise.diagonal().min(),
            asymmetry: (&noise - noise.transpose()).amax(),
        })?;
        self.step_robot(&Vector3::new(step[0], step[1], step[2]));
        for slot in self.landmarks.values_mut() {
            let dim = slot.mean.dim();
            let delta = Tangent::<M::Landmark>::from_fn_generic(dim, nalgebra::Const::<1>, |row, _| step[slot.offset + row]);
            slot.mean = slot.mean.retract(&delta);
        }
        Ok(())
    }
}

/// The rows of all observations below each other.
fn stack<M: LandmarkModel>(accepted: &[Accepted<M>]) -> (SparseJacobian, DMatrix<f64>, DVector<f64>)
where
    DefaultAllocator: SlamAlloc<LandmarkDim<M>, MeasurementDim<M>>,
{
    let n_rows = accepted.iter().map(|accepted| accepted.innovation.residual.len()).sum();
    let mut jacobian = SparseJacobian::default();
    let (mut noise, mut residual) = (DMatrix::zeros(n_rows, n_rows), DVector::zeros(n_rows));
    for Accepted { sighting, innovation } in accepted {
        let (start, linear) = (jacobian.nrows(), &sighting.linearization);
        let size = innovation.residual.len();
        for row in 0..size {
            let robot = [linear.robot[(row, 0)], linear.robot[(row, 1)], linear.robot[(row, 2)]];
            match &linear.landmark {
                Some((offset, by_landmark)) => {
                    jacobian.push_row(robot, *offset, by_landmark.row(row).iter().copied());
                }
                None => jacobian.push_row(robot, 0, std::iter::empty()),
            }
        }
        noise.view_mut((start, start), (size, size)).copy_from(&linear.noise);
        residual.rows_mut(start, size).copy_from(&innovation.residual);
    }
    (jacobian, noise, residual)
}
