use std::collections::BTreeSet;

use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::TangentMatrix;

use super::super::EkfSlam;
use crate::{LandmarkDim, LandmarkId, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc, SlamError};

/// A landmark that is known before the run; `P` is its place.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct AnchorParams<P> {
    /// Its identity: the one that the sensor reads, else any number.
    pub id: u32,
    /// Its place in the map, m: `[x, y]` of a point, `[[x, y], [x, y]]` for the ends of a wall.
    pub at: P,
    /// Covariance in the coordinates of the filter: of `(x, y)` of a point, of `(ρ, α)` of a wall. Without it the place is exact.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none", default))]
    pub covariance: Option<[[f64; 2]; 2]>,
}

/// Why an anchor is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AnchorError {
    /// The sensor reads identities, and never this one.
    #[error("anchor {id}: the log has no detection of landmark {id}, but of {n_seen} others")]
    UnknownId {
        /// The identity of the anchor.
        id: u32,
        /// Number of identities in the log.
        n_seen: usize,
    },
    /// The place or its covariance is no landmark.
    #[error("anchor {id}: {source}")]
    Landmark {
        /// The identity of the anchor.
        id: u32,
        /// Why.
        source: SlamError,
    },
}

impl<M: LandmarkModel> EkfSlam<M>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    /// Adds known landmarks: exact ones as [anchors](Self::add_anchor), the others with their covariance. `seen` are the identities that the sensor
    /// reads, if it does; `landmark` makes the landmark of a place.
    ///
    /// # Errors
    /// Returns an error for the first that is refused; those before it are in the map.
    pub fn add_anchors<P: Copy>(
        &mut self,
        anchors: &[AnchorParams<P>],
        seen: Option<&BTreeSet<u32>>,
        landmark: impl Fn(P) -> M::Landmark,
    ) -> Result<(), AnchorError> {
        for &AnchorParams { id, at, covariance } in anchors {
            if let Some(seen) = seen.filter(|seen| !seen.contains(&id)) {
                return Err(AnchorError::UnknownId { id, n_seen: seen.len() });
            }
            let added = match covariance {
                None => self.add_anchor(LandmarkId(id), landmark(at)),
                Some(rows) => {
                    let entry = |row: usize, column: usize| {
                        rows.get(row).and_then(|row| row.get(column)).copied().unwrap_or(f64::NAN)
                    };
                    self.insert(LandmarkId(id), landmark(at), TangentMatrix::<M::Landmark>::from_fn(entry))
                }
            };
            added.map_err(|source| AnchorError::Landmark { id, source })?;
        }
        Ok(())
    }
}
