use std::{collections::BTreeMap, fs, path::Path};

use anyhow::{Context, Result};

use wayfix_evaluation::report::{Metric, ReportRun};

/// Reviewed reference figures of the stored logs.
///
/// They are not bounds: a difference shows that a code change affected a figure. `--bless` rewrites them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ReferenceFigures(BTreeMap<String, BTreeMap<String, f64>>);

/// Another machine may round the last digits differently; a change of the mathematics shows far above this.
const RELATIVE_TOLERANCE: f64 = 1e-6;

impl ReferenceFigures {
    /// Reads the figures; empty if the file does not exist.
    /// # Errors
    /// Returns an error if the file is there and cannot be read.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        if !path.exists() {
            return Ok(Self::default());
        }
        let text = fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
        Ok(Self(serde_json::from_str(&text).with_context(|| format!("{} is not usable", path.display()))?))
    }

    /// Writes the figures of these runs.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub(crate) fn write<'a>(path: &Path, runs: impl Iterator<Item = &'a ReportRun>) -> Result<()> {
        let figures =
            |run: &ReportRun| run.metrics.iter().map(|metric| (metric.name.clone(), metric.value)).collect();
        let all: BTreeMap<String, BTreeMap<String, f64>> =
            runs.map(|run| (run.name.clone(), figures(run))).collect();
        let text = serde_json::to_string_pretty(&all)? + "\n";
        fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))
    }

    /// Number of figures of a run that differ from the reference, as a figure that must be 0.
    pub(crate) fn compare(&self, run: &ReportRun) -> Option<Metric> {
        let blessed = self.0.get(&run.name)?;
        let differs = |metric: &&Metric| match blessed.get(&metric.name) {
            Some(value) => (metric.value - value).abs() > RELATIVE_TOLERANCE * value.abs().max(1e-9),
            None => false,
        };
        let n_changed = run.metrics.iter().filter(differs).count();
        let source =
            "figures of the stored logs, as accepted in the tree; `--bless` accepts a change after a check";
        Some(Metric::new("n_figures_changed", n_changed as f64, "").at_most(0.0).bound_from(source))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_that_moves_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("figures.json");
        let run = |value| ReportRun {
            name: "r".into(),
            metrics: vec![Metric::new("a", value, "m")],
            ..ReportRun::default()
        };
        ReferenceFigures::write(&path, [run(1.0)].iter()).unwrap();
        let blessed = ReferenceFigures::read(&path).unwrap();
        assert!(blessed.compare(&run(1.0 + 1e-9)).unwrap().passes());
        assert!(!blessed.compare(&run(1.0 + 1e-5)).unwrap().passes());
        assert_eq!(
            ReferenceFigures::read(&folder.path().join("none.json")).unwrap().compare(&run(1.0)),
            None
        );
    }
}
