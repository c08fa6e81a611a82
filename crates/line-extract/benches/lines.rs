//! Simplification of long chains, and walls of a scan: `cargo bench -p wayfix-line-extract`.
//!
//! Prints `bench<TAB>job<TAB>program<TAB>nanoseconds`. The peers are measured by `cargo run --release` in `peers/`, which includes these files
//! so that all figures are of one run.

#[path = "chains.rs"]
mod chains;
#[path = "harness.rs"]
mod harness;
#[path = "jobs.rs"]
mod jobs;
#[path = "../tests/integration/support/mod.rs"]
mod support;

fn main() {
    jobs::run();
}
