//! Predict and update of Wayfix, kfilter and adskalman on the same matrices, in one run.

#[path = "../../benches/harness.rs"]
mod harness;
#[path = "../../benches/jobs.rs"]
mod jobs;
mod adskalman_peer;
mod kfilter_peer;

fn main() {
    jobs::run();
    kfilter_peer::run();
    adskalman_peer::run();
}
