use std::path::Path;

use anyhow::{Result, bail};

use super::{SuitePlan, suites};

/// The runs that a call names: whole suites, or single runs.
///
/// ```
/// use wayfix_experiments::regress::RunSelection;
/// let fixtures = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures");
/// let named = |names: &[&str]| RunSelection::named(names, fixtures.as_ref());
/// assert!(named(&["slam"])?.takes("slam", "rough_known"));
/// let one = named(&["slam/rough_known"])?;
/// assert!(one.takes("slam", "rough_known") && !one.takes("slam", "long_loop"));
/// assert_eq!(one, named(&["rough_known"])?);
/// assert!(named(&["rough_know"]).unwrap_err().to_string().contains("did you mean slam/rough_known?"));
/// # Ok::<(), anyhow::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RunSelection {
    /// Names of suites, each once.
    pub suites: Vec<String>,
    /// Runs as `suite/run`; empty for all runs of the suites.
    pub runs: Vec<String>,
}

impl RunSelection {
    /// All runs of all suites.
    pub fn all() -> Self {
        Self { suites: suites::names().into_iter().map(str::to_owned).collect(), runs: Vec::new() }
    }

    /// The runs that `names` means: a suite, a run, or `suite/run`; all runs if there are no names.
    ///
    /// # Errors
    /// Returns an error with the most similar name if a name is unknown, or if a plan in `fixtures` cannot be read.
    pub fn named(names: &[impl AsRef<str>], fixtures: &Path) -> Result<Self> {
        let known = suites::names();
        if names.is_empty() {
            return Ok(Self::all());
        }
        let mut selection = Self::default();
        if names.iter().all(|name| known.contains(&name.as_ref())) {
            names.iter().for_each(|name| selection.add_suite(name.as_ref()));
            return Ok(selection);
        }
        let mut runs = Vec::new();
        for suite in &known {
            let plan = SuitePlan::read(fixtures, suite)?;
            runs.extend(plan.run.into_iter().map(|run| (*suite, format!("{suite}/{}", run.name))));
        }
        for name in names.iter().map(AsRef::as_ref) {
            let is_meant = |(suite, run): &&(&str, String)| {
                *suite == name || run == name || run[suite.len() + 1..] == *name
            };
            let meant: Vec<_> = runs.iter().filter(is_meant).collect();
            if meant.is_empty() {
                bail!("there is no suite or run `{name}`{}", nearest(name, &known, &runs));
            }
            for (suite, run) in meant {
                selection.add_suite(suite);
                if !selection.runs.contains(run) {
                    selection.runs.push(run.clone());
                }
            }
        }
        Ok(selection)
    }

    /// Whether it contains this run.
    pub fn takes(&self, suite: &str, run: &str) -> bool {
        let is_named =
            |name: &String| name.strip_prefix(suite).is_some_and(|rest| rest.strip_prefix('/') == Some(run));
        self.suites.iter().any(|name| name == suite)
            && (self.runs.is_empty() || self.runs.iter().any(is_named))
    }

    fn add_suite(&mut self, suite: &str) {
        if !self.suites.iter().any(|name| name == suite) {
            self.suites.push(suite.to_owned());
        }
    }
}

/// The most similar name, and where all names are.
fn nearest(name: &str, suites: &[&str], runs: &[(&str, String)]) -> String {
    let of_suites = suites.iter().map(|suite| (strsim::jaro_winkler(name, suite), *suite));
    let of_runs = runs.iter().map(|(suite, run)| {
        let alone = &run[suite.len() + 1..];
        (strsim::jaro_winkler(name, alone).max(strsim::jaro_winkler(name, run)), run.as_str())
    });
    let best = of_suites.chain(of_runs).max_by(|a, b| a.0.total_cmp(&b.0));
    let guess = best.map_or(String::new(), |(_, best)| format!(", did you mean {best}?"));
    format!("{guess} Suites: {}; the runs of each are in fixtures/SUITE.toml", suites.join(", "))
}
