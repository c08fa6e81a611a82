use std::{ops::ControlFlow, path::Path};

use anyhow::Result;
use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_systems::views::{self, DescriptorKind, LoggedViews, ViewsParams};
use wayfix_table_log::{MoveRow, MovedFrameFolder};

/// The corridor as a logged drive whose actions are the order of the frames; frame i is at place i.
///
/// # Errors
/// Returns an error if a folder cannot be read or localized.
pub(crate) fn run_logged(folder: &Path) -> Result<ReportRun> {
    let learned = MovedFrameFolder::read(&folder.join("ref"), None)?;
    let mut drive = MovedFrameFolder::read(&folder.join("query"), None)?;
    for (index, frame) in drive.frames.iter_mut().enumerate() {
        frame.row = Some(MoveRow { file: None, action: Some([1, 0]), place: Some([index, 0]) });
    }
    let params = ViewsParams::default();
    let mut all = ReportRun { name: "corridor-log".to_owned(), ..ReportRun::default() };
    for feature in DescriptorKind::ALL {
        let go_on = |_: &_, _: &_, _: Option<&_>| ControlFlow::Continue(());
        let run = LoggedViews::localize(&learned, &drive, None, feature, &params, go_on)?;
        let ReportRun { metrics, events, .. } = run.summarize();
        let named = |metric: Metric| Metric { name: format!("{}_{}", feature.name(), metric.name), ..metric };
        all.metrics.extend(metrics.into_iter().map(named));
        all.events.extend(events.into_iter().map(|(name, n)| (format!("{}_{name}", feature.name()), n)));
        all.figures = views::logged_plots(&run, feature)?;
    }
    Ok(all)
}
