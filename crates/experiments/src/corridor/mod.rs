//! Localization along a corridor driven twice: the first traverse is learned, the second localized.
//!
//! Made for the corridor of [Milford, *Vision-based place recognition: how low can you go?*, IJRR 2013]: [`run`] takes a folder with the subfolders
//! `ref` and `query` of 111 frames each, where frame i of one matches frame i ± 2 of the other. Places are the frames of the learned traverse. A
//! frame counts as found if the most probable place is at most two off.
//!
//! The filter assumes forward motion: one place per frame, zero or two in a tenth of the frames each. All other parameters are learned from the
//! first traverse ([`Traverse`](wayfix_condensation::RouteAppearanceModel)), but the form of the model was chosen on this corridor. Four variants are reported
//! too: the traverses swapped, vaguer motion, no filter, and frames assumed independent; and the share of short drives, one from each frame, that
//! are localized at the end.

mod figures;
mod localize;
mod logged;
mod plots;
mod run;
mod traverses;

pub(crate) use logged::run_logged;
pub use run::run;
