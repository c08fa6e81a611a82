//! Priors of the light, learned from training venues: one per kind of light.

mod error;
mod evidence;
#[cfg(feature = "serde")]
mod file;
mod k_means;
mod labelled;
mod learn;
mod params;
mod priors;
mod venue;

pub use error::LightingPriorError;
pub use k_means::{KMeans, k_means};
pub use labelled::{LabelledPixels, inner_labels};
pub use learn::{learn_grouped_priors, learn_priors, split_by_brightness};
pub use params::PriorLearningParams;
pub use priors::LightingPriors;
pub use venue::{PooledPixelVariance, TrainingVenue};
