//! Films of one target under changing light, with its true silhouette in every frame.
//!
//! The five [`SyntheticFilm`]s are the four sequences of Andrade-Cetto, Sect. 3.4, and one for his head tracker: **circles** that move about and change
//! their colour at random; a reddish **rectangle** that revolves round a lamp; a **beetle** that walks over the ground in sun
//! and shade; a **snail** in clutter, whose neck has nearly the colour of its shell and goes in and out; a **head** that turns about in a
//! room while the light changes. An [`OcclusionEvent`] hides the target or takes it out of the picture for a while.
//!
//! Paths are sums of incommensurable swings, light is computed in linear radiance, and a camera with automatic exposure, drifting white
//! balance, blur and noise makes bytes of it: no tracker's model is in here.
//!
//! ```
//! use wayfix_scene_sim::film::{SyntheticFilm, OcclusionEvent};
//! let film = SyntheticFilm { n_frames: 2, ..SyntheticFilm::named("snail")? };
//! for frame in film.frames()? {
//!     let [x, y, width, height] = frame.target.bounding_box().expect("in sight");
//!     assert!(x >= 0.0 && y >= 0.0 && width > 40.0 && height > 40.0);
//!     assert!(frame.visible.area() == frame.target.area(), "nothing stands before it");
//! }
//! let away = SyntheticFilm { occlusion: OcclusionEvent::Away, ..SyntheticFilm::named("head")? };
//! assert!(away.frames()?.any(|frame| frame.target.area() == 0));
//! # Ok::<(), wayfix_scene_sim::SimulationError>(())
//! ```

mod board;
mod camera_sensor;
mod catalogue;
mod daylight;
mod frame;
mod frames;
mod ground;
mod occlusion_event;
mod pose;
mod scene_models;
mod silhouette;
mod sine_sum;

pub use catalogue::SyntheticFilm;
pub use frame::FilmFrame;
pub use frames::FilmFrames;
pub use occlusion_event::OcclusionEvent;
pub use silhouette::Silhouette;
