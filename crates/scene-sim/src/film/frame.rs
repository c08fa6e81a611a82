use super::Silhouette;
use crate::scenery::RgbPicture;

/// One picture of a film, and what is true of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    /// What the camera gives.
    pub picture: RgbPicture,
    /// The whole target as far as it lies in the picture, hidden parts included.
    pub target: Silhouette,
    /// The part of the target that nothing hides.
    pub visible: Silhouette,
    /// What belongs to the same creature and not to the target: the neck of the snail. Empty in other films.
    pub distractor: Silhouette,
}
