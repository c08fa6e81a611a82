use super::SyntheticFilm;
use crate::SimulationError;

/// Event that affects the target in the middle of a film. All times are shares of its length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum OcclusionEvent {
    /// Nothing.
    #[default]
    None,
    /// A lath passes before the target and hides about a third of it.
    PartlyHidden,
    /// A board passes before the target and hides all of it for a fifth of a second or more.
    Hidden,
    /// The target leaves the image for more than half a second and returns.
    Away,
}

impl OcclusionEvent {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::None, Self::PartlyHidden, Self::Hidden, Self::Away];

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::PartlyHidden => "partly-hidden",
            Self::Hidden => "hidden",
            Self::Away => "away",
        }
    }

    /// The event of that name.
    ///
    /// # Errors
    /// Returns [`SimulationError::UnknownScenario`] if there is none.
    pub fn named(name: &str) -> Result<Self, SimulationError> {
        let found = Self::ALL.into_iter().find(|event| event.name() == name);
        found.ok_or_else(|| SimulationError::UnknownScenario { name: name.to_owned() })
    }

    /// Displacement of the target to the right, px, at a share of the film's length.
    pub(super) fn aside(self, share: f64) -> f64 {
        let away = SyntheticFilm::SIZE_PX.0 as f64 + 100.0;
        let gone = if share < 0.5 { smooth((share - 0.35) / 0.15) } else { smooth((0.80 - share) / 0.15) };
        if self == Self::Away { away * gone } else { 0.0 }
    }

    /// Left and right edge of the occluder.
    pub(super) fn board(self, share: f64) -> Option<(f64, f64)> {
        let width = match self {
            Self::PartlyHidden => 20.0,
            Self::Hidden => 120.0,
            Self::None | Self::Away => return None,
        };
        let (from, until) = (0.35, 0.75);
        let passed = (share - from) / (until - from);
        let right = passed * (SyntheticFilm::SIZE_PX.0 as f64 + width);
        (0.0..=1.0).contains(&passed).then_some((right - width, right))
    }
}

/// From 0 to 1 with no slope at the ends.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
