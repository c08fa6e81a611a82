//! What a run or a regression found: figures with their bounds, pictures, and where they come from.
//!
//! A [`Report`] holds [`Suite`]s of [`Run`]s of [`Metric`]s. [`Report::write`] puts `report.json` (the contract with programs) and
//! `index.html` (one page without network, for people) into a folder; [`table`] sets it for the terminal and [`RunSummary`] is the
//! object that `wayfix run --json` prints.
//!
//! Times are never among the `metrics`: those are the same bits for any number of threads, and times go into `timings`.

pub mod html;
mod layout;
mod metric;
mod model;
mod number;
mod provenance;
mod run_summary;
pub mod table;
mod tally;
mod write;

pub use layout::foxglove_layout;
pub use metric::{Metric, Peer, Spread};
pub use model::{Report, Run, Suite};
pub use provenance::{Machine, commit};
pub use run_summary::RunSummary;
pub use tally::Tally;
pub use write::ReportError;
