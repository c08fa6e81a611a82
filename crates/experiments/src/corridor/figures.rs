use anyhow::Result;
use wayfix_condensation::StateDescriptorTable;
use wayfix_evaluation::report::Metric;
use wayfix_systems::views::DescriptorKind;

use super::localize::{LocalizationRun, Method, STEADY, TOLERANCE, VAGUE};

/// Results of one feature in the corridor, in all variants.
pub(super) struct Variants {
    pub(super) filtered: LocalizationRun,
    swapped: f64,
    vague_motion: f64,
    independent: f64,
    single_frame: f64,
    after_10_frames: f64,
    after_30_frames: f64,
}

impl Variants {
    pub(super) fn of(learned: &StateDescriptorTable, seen: &StateDescriptorTable) -> Result<Self> {
        let share = |method| LocalizationRun::of(learned, seen, method).map(|journey| journey.share());
        Ok(Self {
            filtered: LocalizationRun::of(learned, seen, Method::Filter(STEADY))?,
            swapped: LocalizationRun::of(seen, learned, Method::Filter(STEADY))?.share(),
            vague_motion: share(Method::Filter(VAGUE))?,
            independent: share(Method::Independent(STEADY))?,
            single_frame: share(Method::SingleFrame)?,
            after_10_frames: found_after(10, learned, seen)?,
            after_30_frames: found_after(30, learned, seen)?,
        })
    }
}

/// Share of short drives, one from each frame, of `n_frames` frames, that are localized at the end. NaN if none is that long.
fn found_after(n_frames: usize, learned: &StateDescriptorTable, seen: &StateDescriptorTable) -> Result<f64> {
    let n_starts = (seen.n_states() + 1).saturating_sub(n_frames);
    let mut n_found = 0;
    for start in 0..n_starts {
        let rows: Vec<Vec<f64>> = seen.rows().skip(start).take(n_frames).map(<[f64]>::to_vec).collect();
        let journey =
            LocalizationRun::of(learned, &StateDescriptorTable::from_rows(&rows)?, Method::Filter(STEADY))?;
        let place = journey.best.last().copied().unwrap_or(0);
        n_found += usize::from(place.abs_diff(start + n_frames - 1) <= TOLERANCE);
    }
    Ok(n_found as f64 / n_starts as f64)
}

/// Share of frames found, first of the main method, then of the variants.
pub(super) fn metrics(variants: &[(DescriptorKind, Variants)]) -> Vec<Metric> {
    let column = |suffix: &'static str, value: fn(&Variants) -> f64| {
        variants
            .iter()
            .map(move |(kind, variants)| Metric::new(format!("{}{suffix}", kind.name()), value(variants), ""))
    };
    column("_localized_frame_share", |v| v.filtered.share())
        .chain(column("_localized_frame_share_swapped", |v| v.swapped))
        .chain(column("_localized_frame_share_vague_motion", |v| v.vague_motion))
        .chain(column("_localized_frame_share_independent", |v| v.independent))
        .chain(column("_localized_frame_share_single_frame", |v| v.single_frame))
        .chain(
            column("_localized_frame_share_after_10_frames", |v| v.after_10_frames)
                .filter(|m| m.value.is_finite()),
        )
        .chain(
            column("_localized_frame_share_after_30_frames", |v| v.after_30_frames)
                .filter(|m| m.value.is_finite()),
        )
        .chain(column("_neighbour_frame_correlation_length", |v| v.filtered.correlation_length))
        .collect()
}
