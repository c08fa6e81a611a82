use std::collections::BTreeMap;

use rand_chacha::ChaCha8Rng;

/// Purpose of a random number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum RandomStreamPurpose {
    /// Places of landmarks.
    Landmarks,
    /// Places of things with unlisted codes.
    UnknownCodes,
    /// Routes of other robots.
    OtherRobots,
    /// The route of the robot.
    Route,
    /// Slip of the wheels.
    Slip,
    /// White noise on odometry.
    OdometryNoise,
    /// White noise on ranges.
    RangeNoise,
    /// White noise on bearings.
    BearingNoise,
    /// Time-correlated errors of each target's range and bearing.
    Drift,
    /// Gross outliers.
    Outlier,
    /// Lost scans.
    Dropout,
    /// Targets in view that are not reported.
    Missed,
    /// Reports of things that are not there.
    Clutter,
    /// Detections with another landmark's identity.
    Mislabel,
    /// Noise on the readings of an external position sensor.
    ExternalPosition,
    /// Noise on the ranges to a reference at the origin.
    Anchor,
    /// Venue: its paints, lamps, camera and people.
    Venue,
    /// Path and rests of a legged robot.
    Walk,
    /// Gaze of a legged robot.
    Gaze,
    /// Errors of its joints.
    Joints,
    /// Slip of its feet.
    Gait,
    /// The automatic white balance.
    WhiteBalance,
    /// Noise of a camera.
    Picture,
    /// Robots, ball and referee on the field.
    UnmappedObjects,
    /// Pose of a robot after a kidnapping.
    Kidnap,
    /// Smooth textures of a flat scene.
    Texture,
    /// Places and colours of the shapes in a flat scene.
    Objects,
    /// Noise of the camera before a flat scene.
    Pixels,
    /// Mixed ranges of laser beams that hit two surfaces.
    MixedPixels,
    /// People in front of a laser.
    People,
    /// Lamps that have aged.
    Lamps,
    /// Clouds.
    Daylight,
    /// People who switch lamps and draw curtains.
    Switching,
    /// People who walk in a building.
    Crowd,
    /// Motion of the target of a film.
    Motion,
    /// Light of a film.
    Light,
    /// A user's own.
    Other(u32),
}

impl RandomStreamPurpose {
    /// The number of the ChaCha stream. Stored fixtures depend on these: never renumber, only append.
    const fn stream(self) -> u64 {
        match self {
            Self::Landmarks => 1,
            Self::UnknownCodes => 2,
            Self::OtherRobots => 3,
            Self::Route => 4,
            Self::Slip => 5,
            Self::OdometryNoise => 6,
            Self::RangeNoise => 7,
            Self::BearingNoise => 8,
            Self::Drift => 9,
            Self::Outlier => 10,
            Self::Dropout => 11,
            Self::Missed => 12,
            Self::Clutter => 13,
            Self::Mislabel => 14,
            Self::ExternalPosition => 15,
            Self::Anchor => 16,
            Self::Venue => 17,
            Self::Walk => 18,
            Self::Gaze => 19,
            Self::Joints => 20,
            Self::Gait => 21,
            Self::WhiteBalance => 22,
            Self::Picture => 23,
            Self::UnmappedObjects => 24,
            Self::Kidnap => 25,
            Self::Texture => 26,
            Self::Objects => 27,
            Self::Pixels => 28,
            Self::MixedPixels => 29,
            Self::People => 30,
            Self::Lamps => 31,
            Self::Daylight => 32,
            Self::Switching => 33,
            Self::Crowd => 34,
            Self::Motion => 40,
            Self::Light => 41,
            Self::Other(n) => (1 << 32) | n as u64,
        }
    }
}

/// One independent generator per [`RandomStreamPurpose`], all from one seed.
///
/// Enabling an error source, or changing its size, does not affect the draws of the others: two logs that differ in one parameter can be
/// compared sample by sample.
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::{Rng, SeedableRng}};
/// use wayfix_scene_sim::random::{RandomStreamPurpose, RandomStreams};
///
/// let mut one = RandomStreams::new(ChaCha8Rng::seed_from_u64(1));
/// let mut other = RandomStreams::new(ChaCha8Rng::seed_from_u64(1));
/// other.of(RandomStreamPurpose::Outlier).next_u64(); // does not disturb …
/// assert_eq!(one.of(RandomStreamPurpose::RangeNoise).next_u64(), other.of(RandomStreamPurpose::RangeNoise).next_u64());
/// ```
#[derive(Clone, Debug)]
pub struct RandomStreams {
    root: ChaCha8Rng,
    open: BTreeMap<RandomStreamPurpose, ChaCha8Rng>,
}

impl RandomStreams {
    /// The streams with the seed of `rng`, each from its beginning, for any position of `rng`.
    pub fn new(rng: ChaCha8Rng) -> Self {
        Self { root: rng, open: BTreeMap::new() }
    }

    /// The generator for one source, where the last draw left it.
    pub fn of(&mut self, source: RandomStreamPurpose) -> &mut ChaCha8Rng {
        self.open.entry(source).or_insert_with(|| {
            let mut rng = self.root.clone();
            rng.set_stream(source.stream());
            rng.set_word_pos(0);
            rng
        })
    }
}
