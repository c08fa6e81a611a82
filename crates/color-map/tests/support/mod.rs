//! What several tests need.
#![allow(dead_code, reason = "each test takes a part")]

use wayfix_color_map::ColorMap;

/// A field of the four-legged league of 2003: 4.2 m × 2.7 m, two goals, six beacons.
#[cfg(feature = "serde")]
pub(crate) fn field() -> ColorMap {
    toml::from_str(include_str!("../field.toml")).expect("the field is a map")
}
