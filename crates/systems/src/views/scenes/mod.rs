//! Images of scenes in which a camera moves.

pub(super) mod composed;
pub(super) mod real_scene;
pub(super) mod register;
pub(super) mod scene;
