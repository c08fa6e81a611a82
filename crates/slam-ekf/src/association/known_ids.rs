use nalgebra::DefaultAllocator;

use super::{Association, DataAssociation};
use crate::{EkfSlam, LandmarkDim, LandmarkModel, MeasurementDim, Observation, RobotDim, SlamAlloc};

/// The sensor reads identities: bar codes, tags, a simulator.
#[derive(Clone, Copy, Debug, Default)]
pub struct KnownIdAssociation;

impl<M: LandmarkModel> DataAssociation<M> for KnownIdAssociation
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    fn associate(
        &mut self,
        filter: &EkfSlam<M>,
        observations: &[Observation<M::Measurement>],
    ) -> Vec<Association> {
        let associate_one = |observation: &Observation<M::Measurement>| match observation.label {
            Some(id) if filter.contains(id) => Association::Matched(id),
            Some(id) => Association::New(id),
            None => Association::Unlabelled,
        };
        observations.iter().map(associate_one).collect()
    }
}
