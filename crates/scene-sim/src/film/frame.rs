use super::Silhouette;
use crate::scenery::RgbPicture;

/// One frame of a film with its truth.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilmFrame {
    /// The camera image.
    pub picture: RgbPicture,
    /// The whole target within the image, hidden parts included.
    pub target: Silhouette,
    /// The visible part of the target.
    pub visible: Silhouette,
    /// Parts of the same animal that do not belong to the target: the neck of the snail. Empty in other films.
    pub distractor: Silhouette,
}
