use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result, ensure};
use wayfix_evaluation::terminal::{print, print_message};
use wayfix_evaluation::{
    plot::SvgPlot,
    report::{
        FullReport, MachineInfo, ReportRun, ReportSuite, RunSummary, foxglove_layout, table,
        table::TableStyle,
    },
};
use wayfix_sensor_log::{LogFormat, McapMessageSink, MessageSinks};
use wayfix_system_core::{EstimateDrawer, EstimateRecorder};

use super::{common::Common, live::Live};

/// The estimates beside the report.
const ESTIMATES: &str = "estimates.mcap";
/// File of the Foxglove layout.
const LAYOUT: &str = "foxglove-layout.json";

/// Makes a folder for output, unless it exists.
pub(super) fn create_folder(folder: &Path) -> Result<()> {
    let name = folder.display();
    ensure!(!folder.is_file(), "{name} is a file, but output needs a folder: give another name");
    fs::create_dir_all(folder).with_context(|| format!("cannot create {name}"))
}

/// Destinations of the results of a `wayfix run`: standard output, and optionally a folder and viewers.
pub(super) struct Outputs<'a> {
    suite: &'static str,
    common: &'a Common,
    live: Option<Live>,
    /// Log file beside the report, if written.
    log: Option<&'static str>,
}

impl<'a> Outputs<'a> {
    /// Makes the folder and starts the live view, where they are wanted.
    pub(super) fn open(suite: &'static str, common: &'a Common) -> Result<Self> {
        if let Some(out) = &common.out {
            create_folder(out)?;
        }
        Ok(Self { suite, common, live: common.live.start()?, log: None })
    }

    /// Whether the records of the log are written beside the estimates.
    pub(super) fn has_echo(&self) -> bool {
        !self.common.no_echo
    }

    /// A file in the folder, where one is wanted.
    pub(super) fn file(&self, name: &str) -> Option<PathBuf> {
        self.common.out.as_ref().map(|out| out.join(name))
    }

    /// Destinations of messages; none without a folder and without a live view. Waits for the first live viewer.
    pub(super) fn sinks(&mut self) -> Result<MessageSinks> {
        let mut sinks: MessageSinks = Vec::new();
        if let Some(path) = self.file(ESTIMATES).filter(|_| !self.common.no_mcap) {
            sinks.push(Box::new(McapMessageSink::create_compressed(path)?));
            self.log = Some(ESTIMATES);
        }
        sinks.extend(self.live.as_ref().map(Live::sink));
        Ok(sinks)
    }

    /// Draws the estimates, if there is a folder or a viewer.
    pub(super) fn estimates<D: EstimateDrawer>(
        &mut self,
        origin: LogFormat,
    ) -> Result<Option<EstimateRecorder<D>>> {
        let sinks = self.sinks()?;
        if sinks.is_empty() {
            return Ok(None);
        }
        let recorder = EstimateRecorder::new(sinks, origin)?;
        Ok(Some(if self.has_echo() { recorder } else { recorder.without_echo() }))
    }

    /// Prints the figures, writes the report if there is a folder, and waits until all viewers have disconnected.
    pub(super) fn show(self, mut run: ReportRun, plots: impl FnOnce() -> Result<Vec<SvgPlot>>) -> Result<()> {
        let Common { json, seed, .. } = *self.common;
        if self.common.out.is_some() {
            run.figures = plots()?;
            run.log = self.log.map(str::to_owned);
            run.layout = self.write_layout()?;
        }
        let figures = if json {
            serde_json::to_string(&RunSummary::new(&run, seed))? + "\n"
        } else {
            table::run(&run, TableStyle::of_stdout())
        };
        if let Some(out) = &self.common.out {
            write_report(out, self.suite, run, seed)?;
        }
        print(figures)?;
        self.live.iter().for_each(Live::stay);
        Ok(())
    }

    /// The layout beside the estimates, where both are wanted and there is one.
    fn write_layout(&self) -> Result<Option<String>> {
        let (Some(path), Some(layout), Some(_)) = (self.file(LAYOUT), foxglove_layout(self.suite), self.log)
        else {
            return Ok(None);
        };
        fs::write(&path, layout).with_context(|| format!("cannot write {}", path.display()))?;
        Ok(Some(LAYOUT.to_owned()))
    }
}

/// File of the picture with this index.
pub(super) fn figure_file(index: usize) -> String {
    format!("figure-{}.svg", index + 1)
}

fn write_report(out: &Path, suite: &str, run: ReportRun, seed: u64) -> Result<()> {
    for (number, figure) in run.figures.iter().enumerate() {
        let path = out.join(figure_file(number));
        fs::write(&path, figure.standalone()).with_context(|| format!("cannot write {}", path.display()))?;
    }
    let log = run.log.as_ref().map(|log| format!(", {log}")).unwrap_or_default();
    let suites = vec![ReportSuite { name: suite.to_owned(), runs: vec![run] }];
    FullReport { suites, seed, machine: MachineInfo::detect(), ..FullReport::default() }
        .write_unjudged(out)?;
    print_message(format!("wrote index.html, report.json{log} and the figures as SVG to {}", out.display()));
    Ok(())
}
