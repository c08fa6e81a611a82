//! Appearance maps: places that are learned, recognized and forgotten by their looks, with
//! [`AppearanceLocalizer`](wayfix_appearance_cml::AppearanceLocalizer).

pub mod experiments;
