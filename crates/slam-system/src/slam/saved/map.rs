use std::{fs, path::Path};

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use wayfix_estimation_traits::Pose2;
use wayfix_slam_ekf::SlamSnapshot;
use wayfix_system_core::write_atomically;

use super::{SavedMapError, envelope};
use crate::slam::{AssociationRule, ExternalState, FrontEndState};

/// All that a [`SlamSystem`](crate::slam::SlamSystem) remembers between two records, in a file.
///
/// Noise, gates and timing are not in it: they are parameters of the robot, so that a robot can continue with better ones. The kind of robot and
/// landmarks and the rule of association must be the same.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SlamState<R, L, S> {
    /// Robot, map and covariance.
    pub filter: SlamSnapshot<R, L>,
    /// The same by the smoother that follows the filter, if one does: its window is marginalized.
    pub smoothed: Option<SlamSnapshot<R, L>>,
    /// How observations find their landmarks.
    pub association: AssociationRule,
    /// The identity of the next new landmark; `None` where the sensor reads identities.
    pub next_id: Option<u32>,
    /// Stamp of the last record that was taken, nanoseconds; a resumed run leaves out what is not later.
    pub taken_until: u64,
    /// Where odometry alone would put the robot.
    pub dead_reckoning: Pose2<f64>,
    /// What it remembers of external sensors.
    pub external: ExternalState,
    /// What the front end remembers.
    pub front_end: S,
}

/// What the state is of. It comes first in the payload: the rest of another kind would decode to nonsense.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Kind {
    robot: String,
    landmark: String,
    robot_dimension: u32,
    landmark_dimension: u32,
}

impl Kind {
    fn of<S: FrontEndState>() -> Self {
        Self {
            robot: S::ROBOT.0.to_owned(),
            landmark: S::LANDMARK.0.to_owned(),
            robot_dimension: S::ROBOT.1 as u32,
            landmark_dimension: S::LANDMARK.1 as u32,
        }
    }

    fn check<S: FrontEndState>(&self) -> Result<(), SavedMapError> {
        let differs = |((what, expected), (_, found)): ((_, String), (&str, String))| {
            (expected != found).then_some(SavedMapError::Kind { what, expected, found })
        };
        let mut pairs = Self::of::<S>().properties().into_iter().zip(self.properties());
        pairs.find_map(differs).map_or(Ok(()), Err)
    }

    fn properties(&self) -> [(&'static str, String); 4] {
        [
            ("robot", self.robot.clone()),
            ("landmark", self.landmark.clone()),
            ("robot dimension", self.robot_dimension.to_string()),
            ("landmark dimension", self.landmark_dimension.to_string()),
        ]
    }
}

impl<R, L, S: FrontEndState> SlamState<R, L, S>
where
    Self: Serialize + DeserializeOwned,
{
    /// The bytes of the file.
    ///
    /// # Errors
    /// Returns an error if the encoder fails; it fails only without memory.
    pub fn to_bytes(&self) -> Result<Vec<u8>, SavedMapError> {
        let kind = postcard::to_stdvec(&Kind::of::<S>()).map_err(SavedMapError::Payload)?;
        let payload = postcard::to_extend(self, kind).map_err(SavedMapError::Payload)?;
        Ok(envelope::seal(&payload))
    }

    /// The map in the bytes of a file.
    ///
    /// # Errors
    /// When it is damaged, of another version or of another kind.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, SavedMapError> {
        let payload = envelope::open(bytes)?;
        let (kind, rest): (Kind, _) = postcard::take_from_bytes(payload).map_err(SavedMapError::Payload)?;
        kind.check::<S>()?;
        let (state, rest) = postcard::take_from_bytes(rest).map_err(SavedMapError::Payload)?;
        if !rest.is_empty() {
            let expected = (bytes.len() - rest.len()) as u64;
            return Err(SavedMapError::Length { expected, found: bytes.len() as u64 });
        }
        Ok(state)
    }

    /// Reads a file.
    ///
    /// # Errors
    /// When it cannot be read, is damaged, or is of another version or kind.
    pub fn read(path: &Path) -> Result<Self, SavedMapError> {
        let bytes = fs::read(path).map_err(|source| SavedMapError::Io { path: path.to_owned(), source })?;
        Self::from_bytes(&bytes)
    }

    /// Replaces a file as a whole: a process that is killed, or a robot that loses power, leaves the old or the new one.
    ///
    /// # Errors
    /// When it cannot be written; the old one is still there then.
    pub fn write(&self, path: &Path) -> Result<(), SavedMapError> {
        let written = write_atomically(path, &self.to_bytes()?);
        written.map_err(|source| SavedMapError::Io { path: path.to_owned(), source })
    }
}

/// Identities that association gave are not those that a sensor reads.
pub(crate) fn check_association(
    asked: Option<AssociationRule>,
    saved: AssociationRule,
) -> Result<(), SavedMapError> {
    match asked {
        Some(asked) if asked != saved => Err(SavedMapError::Kind {
            what: "association",
            expected: format!("{asked:?}").to_lowercase(),
            found: format!("{saved:?}").to_lowercase(),
        }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::points::{PointFrontEndState as Points, SavedPointMap};

    #[test]
    fn a_map_of_another_kind_says_what_differs() {
        for (kind, what) in [
            (Kind { robot: "Ackermann".to_owned(), ..Kind::of::<Points>() }, "robot is Ackermann"),
            (Kind { landmark: "wall".to_owned(), ..Kind::of::<Points>() }, "landmark is wall"),
            (Kind { robot_dimension: 3, ..Kind::of::<Points>() }, "robot dimension is 3, here it is 4"),
            (Kind { landmark_dimension: 3, ..Kind::of::<Points>() }, "landmark dimension is 3, here it is 2"),
        ] {
            let sealed = envelope::seal(&postcard::to_stdvec(&kind).unwrap());
            let error = SavedPointMap::from_bytes(&sealed).unwrap_err();
            assert!(
                matches!(error, SavedMapError::Kind { .. }) && error.to_string().contains(what),
                "{error}"
            );
        }
    }

    #[test]
    fn a_sound_envelope_around_nonsense_is_refused() {
        for garbage in [&[][..], &[0xff; 64], &[0; 64]] {
            assert!(SavedPointMap::from_bytes(&envelope::seal(garbage)).is_err());
        }
    }
}
