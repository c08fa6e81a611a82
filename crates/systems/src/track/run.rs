use wayfix_sensor_log::{Data, Log, ProblemKind, Record};

use super::{RunHistory, TrackError, TrackSystem};
use crate::system::{DriveStep, System, drive};

/// A log that went through a tracker.
pub struct TrackRun {
    /// The system in its last state.
    pub system: TrackSystem,
    /// What can be drawn of it.
    pub run_history: RunHistory,
}

/// Takes the images of a log through a tracker, one at a time, and shows it with each record to `observe`.
///
/// # Errors
/// When the tracker cannot begin, nobody says where the target is, or no frame could be used.
pub fn run(
    mut system: TrackSystem,
    log: &mut Log,
    mut observe: impl FnMut(&TrackSystem, &Record),
) -> Result<TrackRun, TrackError> {
    let mut run_history = RunHistory::default();
    let mut kept = Ok(());
    drive(&mut system, log.by_ref(), |DriveStep { system, record, .. }| {
        // Other records leave the frame as it was.
        if let (Ok(()), Data::Image(_), Some(frame)) = (&kept, &record.data, system.frame()) {
            kept = run_history.observe(frame);
        }
        observe(system, record);
    });
    if let Some(failure) = system.take_failure() {
        return Err(failure);
    }
    kept?;
    // Frames that could not be read at the end leave no gap that a later one shows.
    let unreadable = log.report().problems.get(&ProblemKind::UnreadableImage).copied().unwrap_or(0);
    let shown = system.events().get("frame_unreadable");
    system.pass_over(system.n_frames() + unreadable.saturating_sub(shown) as usize);
    if !system.has_begun() {
        let first = system.events().refusals().first().map(|first| format!(": {first}"));
        return Err(match first {
            None if system.n_frames() > 0 => TrackError::NoStart,
            because => TrackError::NoFrame { because: because.unwrap_or_default() },
        });
    }
    Ok(TrackRun { system, run_history })
}
