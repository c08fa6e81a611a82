//! Flat scenes for a camera that sees one window at a time, and their appearance on another day.
//!
//! A [`Scenery`] is composed of simple shapes and smooth textures. [`ImagingConditions`] renders it with a camera that differs from that of the
//! first image: another response, vignetting, a colour cast, noise, and a shift of some pixels. By default its steps differ from gain, offset and
//! gamma, so that no light model of an estimator fits exactly; [`ImagingConditions::dimmed`] has only these, and noise.
//! ```
//! use wayfix_scene_sim::scenery::{Scenery, ImagingConditions};
//! let lab = Scenery::named("lab")?;
//! let learned = lab.compose();
//! let real = ImagingConditions::default().picture_of(&learned, lab.seed)?;
//! assert_eq!((real.width, real.height), (learned.width, learned.height));
//! assert_ne!(real.rgb, learned.rgb);
//! # Ok::<(), wayfix_scene_sim::SimulationError>(())
//! ```

pub(crate) mod canvas;
mod imaging_conditions;
pub(crate) mod noise;
mod rgb_picture;
mod scenes;

pub use imaging_conditions::ImagingConditions;
pub use rgb_picture::RgbPicture;
pub use scenes::Scenery;
