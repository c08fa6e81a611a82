//! Priors of the colours from one's own labelled images.

mod command;
mod labelled_images;
mod picture;
mod summary;
mod venue_table;

pub(super) use command::{Arguments, main};
