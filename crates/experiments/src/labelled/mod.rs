//! Labelled images of a real field: the first figures of classification in real light.
//!
//! Made for `nao_field`: [`run`] takes a folder with `field.toml` and `images/K.jpg` beside `images/K_labels.png`, what the map shows at the true pose (0 nothing, else the
//! colour's number in the map, from 1 on). Balls and people are not taken out of the labels; pixels next to another label are.
//!
//! Each image is a place of its own, and its prior is learned from the images of the others. At the true pose the light, and its shade, adapt to the image as in the localizer
//! (`KnownPose`). Rates, of labelled pixels:
//! * `prior`: under the prior alone.
//! * `sun`: under the light that the image is mostly in, as `run color` classifies.
//! * `sun_or_shade`: the most probable colour under either.
//! * `built_in_prior_sun_or_shade`: the same from the built-in priors.
//!
//! Each colour is then withheld in turn, as in the lower half of [Schulz & Fox 2004, Table 1], with the joint prior and with the independent one.

mod figures;
mod known_pose;
mod place;
mod rates;
mod run;

pub use run::run;
