//! Rooms, halls and stores, with furniture and people.

pub(super) mod aisles;
pub(super) mod building;
pub(super) mod crowd;
pub(super) mod decor;
pub(super) mod lab;
pub(super) mod shelf;
pub(super) mod store;
pub(super) mod store_params;
