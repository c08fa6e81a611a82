//! Making what is seen comparable with what was learned under another light.

mod light;
mod tone;

pub use light::LightChange;
pub use tone::light_match;
