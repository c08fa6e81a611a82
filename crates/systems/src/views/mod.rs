//! State condensation on images: estimates which view of a scene the robot sees, from global image features.
//!
//! A [`ViewSystem`] learns one image of a scene and drives in another image of it, taken later. [`run`] makes many drives between random
//! places, [`summarize`] gives their figures and [`plots`] shows them.
//! [`LoggedViews`] localizes a logged drive. [`composed_scene_pair`] makes scenes that need no file. [`p_value_metrics`] and
//! [`compare_choices`] compute further metrics.
//!
//! ```
//! use wayfix_systems::views::{self, DescriptorKind, LightNormalization, RealSceneTransform, ViewSystemConfig, ViewsParams};
//! use wayfix_condensation::RgbImage;
//! let pixel = |i: usize| {
//!     let (x, y) = ((i % 160) as f64, (i / 160) as f64);
//!     [x / 23.0 + (y / 31.0).sin(), x * y / 3000.0, y / 19.0].map(|phase| (60.0 * phase.sin() + 120.0) as u8)
//! };
//! let learned = RgbImage::from_raw(160, 120, (0..160 * 120).flat_map(pixel).collect()).expect("3 bytes a pixel");
//! let real = RealSceneTransform::default().of(&learned)?; // other light, some pixels aside
//! let setup = ViewSystemConfig { view: 64, step: 16, feature: DescriptorKind::Joined, normalization: LightNormalization::WholeScene };
//! let run = views::run(&learned, &real, &setup, &ViewsParams::default(), 10, 1, &|| ())?;
//! assert!(run.trials.iter().filter(|trial| trial.succeeded()).count() >= 9);
//! # Ok::<(), views::ViewsError>(())
//! ```

mod choices;
mod error;
mod estimates;
mod feature;
mod figures;
mod logged;
mod logged_plots;
mod normalization;
mod params;
mod plots;
mod run;
mod scenes;
mod statistics;
mod system;

pub use choices::{INFORMED, compare_choices};
pub use error::ViewsError;
pub use estimates::draw_drive;
pub use feature::DescriptorKind;
pub use figures::summarize;
pub use logged::{LoggedView, LoggedViews};
pub use logged_plots::{LoggedDrawing, logged_plots};
pub use normalization::LightNormalization;
pub use params::ViewsParams;
pub use plots::shade;
pub use plots::{belief_film, feature_plot, plots};
pub use run::{ViewsRun, run};
pub use scenes::composed::composed_scene_pair;
pub use scenes::real_scene::RealSceneTransform;
pub use scenes::register::mean_shift;
pub use scenes::scene::{SceneImage, read_scene};
pub use statistics::p_value_metrics;
pub use system::{ViewSystem, ViewSystemConfig, ViewTrial, ViewTrialStep};
