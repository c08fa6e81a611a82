//! The pictures in which a camera looks around.

pub(super) mod composed;
pub(super) mod real_scene;
pub(super) mod register;
pub(super) mod scene;
