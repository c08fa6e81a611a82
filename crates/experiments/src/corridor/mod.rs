//! Places along a corridor that was driven twice: learned in one traverse, found again in the other.
//!
//! Made for the corridor of [Milford, *Vision-based place recognition: how low can you go?*, IJRR 2013]: [`run`] takes a folder with the
//! subfolders `ref` and `query` of 111 frames each, frame i of one showing what frame i ± 2 of the other does. Places are the frames of the
//! traverse that was learned. A frame is found when the place believed in is at most two off.
//!
//! The filter knows that the robot drives on: one place a frame, none or two in a tenth of the frames each. The rest is learned from the first
//! traverse alone ([`Traverse`](wayfix_condensation::Traverse)), but the form of the model was settled while
//! looking at this corridor. Beside it stand the figures
//! of four variants: the traverses swapped, a vaguer idea of the motion, no filter at all, and frames taken for independent; and the share of
//! short drives that are found at the end, when one begins at each of the frames.

mod figures;
mod localize;
mod pictures;
mod run;
mod traverses;

pub use run::run;
