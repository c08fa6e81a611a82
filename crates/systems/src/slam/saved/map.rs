use std::{fs, path::Path};

use serde::{Deserialize, Serialize, de::DeserializeOwned};

use super::{SavedMapError, envelope};
use crate::{saved::write_atomically, slam::AssociationRule};

/// All that a system remembers between two records, and of what kind it is.
pub trait SavedState: Serialize + DeserializeOwned {
    /// The robot's state, in words, and how many numbers it has.
    const ROBOT: (&str, usize);
    /// The same of a landmark.
    const LANDMARK: (&str, usize);
}

/// A system whose state can be saved.
pub trait Save {
    /// What it remembers.
    type State: SavedState;
    /// All that is needed to go on from here.
    fn save(&self) -> Saved<Self::State>;
}

/// What a system saves, in a file.
///
/// Noise, gates and timing are not in it: they are parameters of the robot and come from its settings, so that a robot can go on with better
/// ones. What must be the same is checked: the kind of robot and landmarks, and how detections find their landmarks.
#[derive(Clone, Debug, PartialEq)]
pub struct Saved<S> {
    /// The state of the system.
    pub state: S,
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
    fn of<S: SavedState>() -> Self {
        Self {
            robot: S::ROBOT.0.to_owned(),
            landmark: S::LANDMARK.0.to_owned(),
            robot_dimension: S::ROBOT.1 as u32,
            landmark_dimension: S::LANDMARK.1 as u32,
        }
    }

    fn check<S: SavedState>(&self) -> Result<(), SavedMapError> {
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

impl<S: SavedState> Saved<S> {
    /// The bytes of the file.
    ///
    /// # Errors
    /// When the encoder refuses, which it does not for want of anything but memory.
    pub fn to_bytes(&self) -> Result<Vec<u8>, SavedMapError> {
        let kind = postcard::to_stdvec(&Kind::of::<S>()).map_err(SavedMapError::Payload)?;
        let payload = postcard::to_extend(&self.state, kind).map_err(SavedMapError::Payload)?;
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
        Ok(Self { state })
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
    use nalgebra::Vector2;
    use wayfix_slam_ekf::ScaledPose;

    use super::*;
    use crate::{
        points::{PointMemory, SavedMap},
        slam::SlamState,
    };

    type State = SlamState<ScaledPose, Vector2<f64>, PointMemory>;

    #[test]
    fn a_map_of_another_kind_says_what_differs() {
        for (kind, what) in [
            (Kind { robot: "Ackermann".to_owned(), ..Kind::of::<State>() }, "robot is Ackermann"),
            (Kind { landmark: "wall".to_owned(), ..Kind::of::<State>() }, "landmark is wall"),
            (Kind { robot_dimension: 3, ..Kind::of::<State>() }, "robot dimension is 3, here it is 4"),
            (Kind { landmark_dimension: 3, ..Kind::of::<State>() }, "landmark dimension is 3, here it is 2"),
        ] {
            let sealed = envelope::seal(&postcard::to_stdvec(&kind).unwrap());
            let error = SavedMap::from_bytes(&sealed).unwrap_err();
            assert!(
                matches!(error, SavedMapError::Kind { .. }) && error.to_string().contains(what),
                "{error}"
            );
        }
    }

    #[test]
    fn a_sound_envelope_around_nonsense_is_refused() {
        for garbage in [&[][..], &[0xff; 64], &[0; 64]] {
            assert!(SavedMap::from_bytes(&envelope::seal(garbage)).is_err());
        }
    }
}
