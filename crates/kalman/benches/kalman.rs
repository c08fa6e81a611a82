//! One predict and update, in nanoseconds: `cargo bench -p wayfix-kalman`.
//!
//! Prints `bench<TAB>job<TAB>program<TAB>nanoseconds`. The peers are measured by `cargo run --release` in `peers/`, which includes this file
//! so that all figures are of one run.

#[path = "harness.rs"]
mod harness;
#[path = "jobs.rs"]
mod jobs;

fn main() {
    jobs::run();
}
