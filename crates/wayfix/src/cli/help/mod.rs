//! Help for the use of the program: completions, manual pages, available optional parts.

pub(super) mod completions;
pub(super) mod doctor;
pub(super) mod manual;
