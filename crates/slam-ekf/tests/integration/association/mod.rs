//! Which observation is of which landmark, and when a landmark is one.

mod confirmation;
mod joint_compatibility;
mod neighbours;
