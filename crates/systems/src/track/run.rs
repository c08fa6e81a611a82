use wayfix_sensor_log::{Log, RecordData, RowProblemKind};
use wayfix_system_core::{RunStep, System, drive};

use super::{TrackRunHistory, TrackSystem, TrackSystemError};

/// Results of a tracker on a log.
pub struct TrackRun {
    /// The system in its last state.
    pub system: TrackSystem,
    /// Data kept for the pictures.
    pub run_history: TrackRunHistory,
}

/// Processes the images of a log with a tracker, one at a time, and shows each record with the system to `observe`.
///
/// # Errors
/// Returns an error if the tracker cannot start, the start of the target is unknown, or no frame is usable.
pub fn run(
    mut system: TrackSystem,
    log: &mut Log,
    mut observe: impl FnMut(RunStep<'_, TrackSystem>),
) -> Result<TrackRun, TrackSystemError> {
    let mut run_history = TrackRunHistory::default();
    let mut kept = Ok(());
    drive(&mut system, log.by_ref(), |step| {
        let RunStep { system, record, .. } = step;
        // Only image records change the frame.
        if let (Ok(()), RecordData::Image(_), Some(frame)) = (&kept, &record.data, system.frame()) {
            kept = run_history.observe(frame);
        }
        observe(step);
    });
    if let Some(failure) = system.take_failure() {
        return Err(failure);
    }
    kept?;
    // Count unreadable frames at the end of the sequence, which no later index reveals.
    let unreadable = log.report().problems.get(&RowProblemKind::UnreadableImage).copied().unwrap_or(0);
    let shown = system.events().get("frame_unreadable");
    system.pass_over(system.n_frames() + unreadable.saturating_sub(shown) as usize);
    let n_searched = system.events().get("head_not_detected");
    if !system.has_begun() && n_searched > 0 {
        return Err(TrackSystemError::NoHead { n_frames: n_searched });
    }
    if !system.has_begun() {
        let first = system.events().refusals().first().map(|first| format!(": {first}"));
        return Err(match first {
            None if system.n_frames() > 0 => TrackSystemError::NoStart,
            because => TrackSystemError::NoFrame { because: because.unwrap_or_default() },
        });
    }
    Ok(TrackRun { system, run_history })
}
