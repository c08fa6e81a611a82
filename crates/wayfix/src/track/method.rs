use clap::ValueEnum;
use wayfix_condensation::{
    BoundingBox, CondensationError, CorrelationTracker, CorrelationTrackerParams, Picture,
};

use super::{Follower, TrackParams};

/// Which tracker follows the target.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Method {
    /// A correlation filter over gradients and colours: for boxes around anything.
    #[default]
    Box,
}

impl Method {
    /// A tracker that begins with a box in the first picture.
    ///
    /// # Errors
    /// What the tracker says of the box or its parameters.
    pub fn begin(
        self,
        _params: &TrackParams,
        picture: &Picture,
        init: BoundingBox,
    ) -> Result<Box<dyn Follower>, CondensationError> {
        Ok(Box::new(CorrelationTracker::new(picture, init, CorrelationTrackerParams::default())?))
    }
}
