use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result};

use super::{PlannedRun, RegressOptions};

/// A run of a plan with its inputs.
#[derive(Clone, Debug)]
pub(crate) struct PlannedJob<'a> {
    /// Command-line options.
    pub options: &'a RegressOptions,
    /// The run.
    pub planned: &'a PlannedRun,
    /// Path of its log, if it has one.
    pub path: Option<PathBuf>,
}

impl PlannedJob<'_> {
    /// Path of its log.
    /// # Errors
    /// Returns an error if the plan names none.
    pub(crate) fn log(&self) -> Result<&PathBuf> {
        self.path.as_ref().with_context(|| format!("run {}: give `log` or `data`", self.planned.name))
    }

    /// Name and place of the estimates that the run writes beside the report.
    pub(crate) fn estimates_file(&self) -> (String, PathBuf) {
        let seed = self.options.seed;
        let name = match &self.planned.name {
            name if self.options.n_seeds > 1 => format!("{name}-seed-{seed}.mcap"),
            name => format!("{name}.mcap"),
        };
        let path = self.options.out.join(&name);
        (name, path)
    }

    /// Path of a file of the recordings.
    /// # Errors
    /// Returns an error if there is no folder of recordings.
    pub(crate) fn recording(&self, file: &Path) -> Result<PathBuf> {
        let data = self.options.data.as_ref().context("recordings need `--data`")?;
        Ok(data.join(file))
    }

    /// Path of a file beside the plan.
    pub(crate) fn beside_plan(&self, file: &Path) -> PathBuf {
        self.options.fixtures.join(file)
    }

    /// A file beside the plan, as text.
    ///
    /// # Errors
    /// Returns an error if it cannot be read.
    pub(crate) fn read(&self, file: &Path) -> Result<String> {
        let path = self.beside_plan(file);
        fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))
    }
}
