//! What helps to use the program: completions, manual pages, what of the optional parts is there.

pub(super) mod completions;
pub(super) mod doctor;
pub(super) mod manual;
