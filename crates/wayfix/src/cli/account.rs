use wayfix_sensor_log::{LogEnd, ReadReport};

use super::output::tell;
use crate::system::Events;

/// Names what was refused, and counts what could not be read.
pub(super) fn account(events: &mut Events, read: &ReadReport) {
    for refusal in events.refusals() {
        tell(format!("refused {refusal}"));
    }
    let n_unlisted = events.n_refusals() - events.refusals().len() as u64;
    if n_unlisted > 0 {
        tell(format!("refused … and {n_unlisted} more"));
    }
    events.add("log_problem", read.n_problems());
    if read.end != LogEnd::Complete {
        events.count("log_incomplete");
    }
}
