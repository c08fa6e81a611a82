use clap::ValueEnum;
use rand::Rng;
use wayfix_condensation::{BoundingBox, CondensationError, Picture, Target, TrackStatus, Tracker};

use super::{Follower, TrackParams};

/// Which tracker follows the target.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Method {
    /// Stand-in.
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
        params: &TrackParams,
        picture: &Picture,
        init: BoundingBox,
    ) -> Result<Box<dyn Follower>, CondensationError> {
        let _ = (params, picture);
        Ok(Box::new(Still(init)))
    }
}

struct Still(BoundingBox);

impl Tracker for Still {
    fn track<R: Rng + ?Sized>(
        &mut self,
        _picture: &Picture,
        _rng: &mut R,
    ) -> Result<Target, CondensationError> {
        Ok(Target { bounding_box: self.0, outline: Vec::new(), status: TrackStatus::Tracked, quality: 1.0 })
    }
}
