use std::{collections::BTreeMap, path::Path};

use anyhow::{Context, Result, bail};
use wayfix_evaluation::report::ReportRun;
use wayfix_system_core::Stopwatch;

use super::{figures, score::score, venue::Venue};

/// Fewer venues leave too little to learn from.
const MIN_VENUES: usize = 3;

/// Leave-one-out over the venues below `folder`; see the [module](super) for the figures.
/// # Errors
/// Returns an error if the folder has fewer than three venues, or a venue has no usable ball.
pub fn run(folder: &Path) -> Result<ReportRun> {
    let stopwatch = Stopwatch::start();
    let mut venues = Venue::read_all(folder)?;
    let unusable: Vec<String> =
        venues.iter_mut().flat_map(|venue| std::mem::take(&mut venue.unusable)).collect();
    if !unusable.is_empty() {
        venues.retain(|venue| !venue.images.is_empty());
    }
    if venues.len() < MIN_VENUES {
        bail!(
            "{} has {} venues (day/robot), at least {MIN_VENUES} are needed",
            folder.display(),
            venues.len()
        );
    }
    let left_out = |(k, venue): (usize, &Venue)| {
        let others: Vec<&Venue> =
            venues.iter().enumerate().filter(|(other, _)| *other != k).map(|(_, venue)| venue).collect();
        score(venue, &others).with_context(|| format!("venue {}", venue.name))
    };
    let scores = venues.iter().enumerate().map(left_out).collect::<Result<Vec<_>>>()?;
    let n_images = venues.iter().map(|venue| venue.images.len() as u64).sum();
    let n_skipped = venues.iter().map(|venue| venue.n_skipped).sum();
    Ok(ReportRun {
        name: "venues".to_owned(),
        metrics: figures::metrics(&scores),
        seconds: stopwatch.elapsed().as_secs_f64(),
        events: BTreeMap::from([
            ("image".to_owned(), n_images),
            ("image_without_carpet".to_owned(), n_skipped),
            ("image_unusable".to_owned(), unusable.len() as u64),
        ]),
        figures: figures::plots(&venues, &scores)?,
        notes: vec![figures::note(&scores)],
        warnings: warning(&unusable).into_iter().collect(),
        ..ReportRun::default()
    })
}

/// So many images are named.
const MOST_NAMED: usize = 3;

fn warning(unusable: &[String]) -> Option<String> {
    let named = unusable.iter().take(MOST_NAMED).map(String::as_str).collect::<Vec<_>>().join("; ");
    (!unusable.is_empty()).then(|| format!("{} images are left out: {named}", unusable.len()))
}
