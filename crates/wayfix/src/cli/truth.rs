use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use wayfix_sensor_log::{LogFormat, LogOpenOptions, PoseKind, Record, RecordData};
use wayfix_system_core::check_overlap;

use super::read_problems::read_all;

// No documentation: it would become that of every command that takes these arguments.
#[derive(clap::Args)]
pub(super) struct TruthFile {
    /// True poses that replace those of the log: `t x y z qx qy qz qw` lines (TUM), on the clock of the log.
    #[arg(long, value_name = "FILE")]
    pub(super) truth: Option<PathBuf>,
}

impl TruthFile {
    /// The records with the true poses of the file, where one is given.
    pub(super) fn put_into(&self, records: Vec<Record>) -> Result<Vec<Record>> {
        let Some(path) = &self.truth else { return Ok(records) };
        with_truth(records, path).with_context(|| format!("cannot use the truth in {}", path.display()))
    }
}

/// Replaces the true poses and positions of the log by those of the file.
fn with_truth(mut records: Vec<Record>, path: &Path) -> Result<Vec<Record>> {
    let options =
        LogOpenOptions { format: Some(LogFormat::Tum), poses: PoseKind::True, ..LogOpenOptions::default() };
    let (poses, _) = read_all(wayfix_sensor_log::open(path, &options)?);
    let is_true = |data: &RecordData| matches!(data, RecordData::TruePose(_) | RecordData::TruePosition(_));
    if !poses.iter().any(|record| is_true(&record.data)) {
        bail!("it holds no pose");
    }
    records.retain(|record| !is_true(&record.data));
    records.extend(poses);
    records.sort_by_key(|record| record.stamp); // at equal stamps the log's order is kept, and truth comes last
    check_overlap(
        &records,
        ("the truth", |data| matches!(data, RecordData::TruePose(_))),
        ("the log", |data| {
            !matches!(data, RecordData::TruePose(_) | RecordData::TrueLandmark(_) | RecordData::TrueWall(_))
        }),
    )?;
    Ok(records)
}
