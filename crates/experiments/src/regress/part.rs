use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result, bail, ensure};
use serde::{Deserialize, Serialize};
use wayfix_evaluation::report::{ReportRun, commit, replace_file};

use super::{CampaignShard, CompletedRun, RegressOptions, RunSelection, SeededRun, cells};

/// Results of one shard, as a file: `part.json` in its output folder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ShardResults {
    /// The work of all shards together; equal in all of them.
    campaign: Campaign,
    /// The runs of this shard.
    runs: Vec<PartRun>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Campaign {
    version: String,
    commit: Option<String>,
    n_shards: usize,
    suites: Vec<String>,
    runs: Vec<String>,
    seed: u64,
    n_seeds: u64,
    quick: bool,
    cells: Vec<SeededRun>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct PartRun {
    cell: SeededRun,
    run: ReportRun,
    /// The pictures, which a report stores only in its page.
    svgs: Vec<String>,
}

const FILE: &str = "part.json";

impl ShardResults {
    /// The results of `shard`.
    /// # Errors
    /// Returns an error if a plan cannot be read.
    pub(crate) fn new(options: &RegressOptions, shard: CampaignShard, done: &[CompletedRun]) -> Result<Self> {
        let campaign = Campaign {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: commit(&options.fixtures),
            n_shards: shard.total(),
            suites: options.selection.suites.clone(),
            runs: options.selection.runs.clone(),
            seed: options.seed,
            n_seeds: options.n_seeds,
            quick: options.quick,
            cells: cells(options)?,
        };
        let svgs = |run: &ReportRun| run.figures.iter().map(|figure| figure.svg.clone()).collect();
        let runs = done
            .iter()
            .map(|CompletedRun { cell, run }| PartRun {
                cell: cell.clone(),
                run: run.clone(),
                svgs: svgs(run),
            })
            .collect();
        Ok(Self { campaign, runs })
    }

    /// Writes `part.json` into `folder`.
    ///
    /// # Errors
    /// Returns an error if it cannot be written.
    pub(crate) fn write(&self, folder: &Path) -> Result<PathBuf> {
        let path = folder.join(FILE);
        replace_file(&path, serde_json::to_string(self)?)
            .with_context(|| format!("cannot write {}", path.display()))?;
        Ok(path)
    }

    /// Reads the `part.json` of a folder.
    ///
    /// # Errors
    /// Returns an error if it is missing or is no part.
    pub(crate) fn read(folder: &Path) -> Result<Self> {
        let path = folder.join(FILE);
        let text = fs::read(&path).with_context(|| {
            format!(
                "cannot read {}: is it the output folder of `wayfix-experiments regress --shard`?",
                path.display()
            )
        })?;
        let mut part: Self =
            serde_json::from_slice(&text).with_context(|| format!("{} is not usable", path.display()))?;
        for PartRun { run, svgs, .. } in &mut part.runs {
            ensure!(run.figures.len() == svgs.len(), "{}: a picture without a drawing", path.display());
            for (figure, svg) in run.figures.iter_mut().zip(std::mem::take(svgs)) {
                figure.svg = svg;
            }
        }
        Ok(part)
    }
}

impl ShardResults {
    /// The runs in `folder` that the same call has finished there before it was interrupted, without those that failed; empty without a file.
    ///
    /// # Errors
    /// Returns an error if the file is of another campaign or not usable.
    pub(crate) fn finished(
        folder: &Path,
        options: &RegressOptions,
        shard: CampaignShard,
    ) -> Result<Vec<CompletedRun>> {
        if !folder.join(FILE).exists() {
            return Ok(Vec::new());
        }
        let part = Self::read(folder)?;
        ensure!(
            part.campaign == Self::new(options, shard, &[])?.campaign,
            "{} is of another campaign: the same version, commit, runs, seeds and data are needed to resume",
            folder.join(FILE).display()
        );
        let done = part.runs.into_iter().map(|PartRun { cell, run, .. }| CompletedRun { cell, run });
        Ok(done.filter(|done| done.run.error.is_none()).collect())
    }
}

/// Puts the parts of all shards together: the options of the whole campaign, and all that was done.
///
/// # Errors
/// Returns an error if the parts are of different campaigns, one is missing, or the same work was done twice. The message says which.
pub(crate) fn join(
    parts: Vec<(PathBuf, ShardResults)>,
    fixtures: &Path,
    out: &Path,
) -> Result<(RegressOptions, Vec<CompletedRun>)> {
    let Some(campaign) = parts.first().map(|(_, part)| part.campaign.clone()) else {
        bail!("no parts: give the output folders of all shards");
    };
    let mut done: BTreeMap<SeededRun, ReportRun> = BTreeMap::new();
    for (path, part) in parts {
        ensure!(
            part.campaign == campaign,
            "{} is of another campaign than the first: the same version, commit, suites, seeds, data and number of shards are needed",
            path.display()
        );
        for PartRun { cell, run, .. } in part.runs {
            let SeededRun { suite, run: name, seed } = cell.clone();
            ensure!(
                done.insert(cell, run).is_none(),
                "{suite} / {name} with seed {seed} was done twice, again in {}",
                path.display()
            );
        }
    }
    let wanted: BTreeSet<&SeededRun> = campaign.cells.iter().collect();
    if let Some(SeededRun { suite, run, seed }) = wanted.iter().find(|cell| !done.contains_key(**cell)) {
        let n_missing = wanted.len() - done.len();
        bail!(
            "{n_missing} of {} runs are missing, the first is {suite} / {run} with seed {seed}: there were {} shards",
            wanted.len(),
            campaign.n_shards
        );
    }
    let options = RegressOptions {
        selection: RunSelection { suites: campaign.suites, runs: campaign.runs },
        fixtures: fixtures.to_owned(),
        data: None,
        out: out.to_owned(),
        seed: campaign.seed,
        n_seeds: campaign.n_seeds,
        quick: campaign.quick,
        bless: false,
    };
    Ok((options, done.into_iter().map(|(cell, run)| CompletedRun { cell, run }).collect()))
}
