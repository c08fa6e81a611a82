//! Flat scenes for a camera that looks at one window of them at a time, and how they look on another day.
//!
//! A [`Scenery`] is composed of simple shapes and smooth textures. A [`ImagingConditions`] renders it through a camera that is not the one of
//! the first picture: another response, light that falls off, a cast of colour, noise, and a shift of some pixels. By default it is made of
//! other steps than gain, offset and gamma, so that no light model of an estimator fits it exactly; [`ImagingConditions::dimmed`] has just these, and noise.
//!
//! ```
//! use wayfix_scene_sim::scenery::{Scenery, ImagingConditions};
//! let lab = Scenery::named("lab")?;
//! let learned = lab.compose();
//! let real = ImagingConditions::default().picture_of(&learned, lab.seed)?;
//! assert_eq!((real.width, real.height), (learned.width, learned.height));
//! assert_ne!(real.rgb, learned.rgb);
//! # Ok::<(), wayfix_scene_sim::SimError>(())
//! ```

pub(crate) mod canvas;
mod imaging_conditions;
pub(crate) mod noise;
mod rgb_picture;
mod scenes;

pub use imaging_conditions::ImagingConditions;
pub use rgb_picture::RgbPicture;
pub use scenes::Scenery;
