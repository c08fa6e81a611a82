use std::{collections::BTreeMap, path::Path};

use anyhow::Result;
use wayfix_evaluation::report::ReportRun;
use wayfix_system_core::Stopwatch;
use wayfix_systems::views::DescriptorKind;

use super::{
    figures::{Variants, metrics},
    plots::plots,
    traverses::{Traverses, features},
};

/// Learns one traverse and localizes the other; see the [module](super) for the figures.
/// # Errors
/// Returns an error if a folder cannot be read, a frame not be decoded, or there are too few.
pub fn run(folder: &Path) -> Result<ReportRun> {
    let stopwatch = Stopwatch::start();
    let traverses = Traverses::read(folder)?;
    let variants = |kind: DescriptorKind| {
        let (learned, seen) = (features(&traverses.learned, kind)?, features(&traverses.seen, kind)?);
        Ok((kind, Variants::of(&learned, &seen)?))
    };
    let variants: Vec<(DescriptorKind, Variants)> =
        DescriptorKind::ALL.into_iter().map(variants).collect::<Result<_>>()?;
    Ok(ReportRun {
        name: "corridor".to_owned(),
        metrics: metrics(&variants),
        events: BTreeMap::from([
            ("place".to_owned(), traverses.learned.len() as u64),
            ("frame".to_owned(), traverses.seen.len() as u64),
        ]),
        figures: plots(&traverses, &variants)?,
        seconds: stopwatch.elapsed().as_secs_f64(),
        ..ReportRun::default()
    })
}
