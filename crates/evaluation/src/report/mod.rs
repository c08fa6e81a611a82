//! Report of a run or a regression test: figures with their bounds, pictures, and provenance.
//!
//! A [`FullReport`] holds [`ReportSuite`]s of [`ReportRun`]s of [`Metric`]s. [`FullReport::write`] writes `report.json` (the interface for programs) and `index.html`
//! (one page that works offline, for people) to a folder. [`table`] formats it for the terminal, and [`RunSummary`] is the object that
//! `wayfix run --json` prints.
//!
//! Times are not among the `metrics`, which have equal bits for any number of threads; times are in `timings`.

mod explanation;
pub mod html;
mod layout;
mod metric;
mod model;
mod number;
mod provenance;
mod run_summary;
pub mod table;
mod tally;
mod verdicts;
mod write;

pub use explanation::explanation;
pub use layout::foxglove_layout;
pub use metric::{ConfidenceInterval, Metric, PeerValue};
pub use model::{FullReport, ReportRun, ReportSuite};
pub use provenance::{MachineInfo, commit};
pub use run_summary::RunSummary;
pub use tally::PassFailCount;
pub use verdicts::{failures, run_line};
pub use write::{ReportError, replace_file};
