//! The field of the four-legged league, a robot that walks on it, and its camera images in good and bad light.
//!
//! The truth about shapes is [`field_map`], which an estimator may use. The true colours follow no estimator's model: [`LampLight`] with
//! colour temperatures and fall-off shine on [`LeagueVenue`]-own paints, and a [`CameraSimulator`] converts it to bytes with a soft lens, motion blur,
//! vignetting, crosstalk, drifting white balance, shot noise, saturation, gamma and shared chroma, in front of a [`HallBackdrop`] full of people.

mod backdrop;
mod drive;
mod field;
mod illuminant;
mod light;
mod params;
mod picture;
mod records;
mod robot;
mod sun;
mod things;
mod venue;
mod yuv;

pub use backdrop::{Backdrop, HallBackdrop, SurfaceHit};
pub use drive::{LeagueDrive, LeagueFrame};
pub use field::{COLOR_NAMES, N_COLORS, field_map, landmarks};
pub use illuminant::black_body;
pub use light::{Lamp, LampLight, LightField, LinearRgb};
pub use params::LeagueParams;
pub use picture::{
    CameraParams, CameraSimulator, ChromaSubsampling, ExposureMode, LeaguePicture, LeagueScene, Material,
    SceneSurface, SurfaceShape,
};
pub use robot::{
    BodySwayParams, FieldWalkParams, GaitOdometryParams, LeggedRobot, LeggedRobotParams, RobotHeadParams,
};
pub use sun::SunThroughWindows;
pub use things::UnmappedObjects;
pub use venue::{LampSetting, LeagueVenue};
