use rand_chacha::ChaCha8Rng;
use wayfix_condensation::{CondensationError, Picture, Target, Tracker};

/// Any tracker, behind one type.
pub trait Follower {
    /// Takes the next picture.
    ///
    /// # Errors
    /// As [`Tracker::track`].
    fn follow(&mut self, picture: &Picture, rng: &mut ChaCha8Rng) -> Result<Target, CondensationError>;

    /// Mean colour of what is followed, red, green and blue from 0 to 1, for trackers that know it.
    fn color(&self) -> Option<[f64; 3]> {
        None
    }
}

impl<T: Tracker> Follower for T {
    fn follow(&mut self, picture: &Picture, rng: &mut ChaCha8Rng) -> Result<Target, CondensationError> {
        self.track(picture, rng)
    }
}
