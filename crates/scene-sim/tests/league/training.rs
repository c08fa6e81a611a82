//! Training venues: two groups of light, colours that keep their order, colours that are missing.

use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_scene_sim::league::{LampSetting, N_COLORS, TrainingVenue, TrainingVenuesParams};

use crate::support::mean;

fn sets() -> Vec<TrainingVenue> {
    TrainingVenuesParams::default().gather(ChaCha8Rng::seed_from_u64(44)).expect("sound parameters")
}

/// Mean of one channel of one colour over the pictures that show it.
fn mean_of(set: &TrainingVenue, color: usize, channel: usize) -> Option<f64> {
    let values: Vec<f64> = set.images.iter().filter_map(|i| i.means[color]).map(|yuv| yuv[channel]).collect();
    (!values.is_empty()).then(|| mean(&values))
}

#[test]
fn forty_four_sets_in_two_groups() {
    let sets = sets();
    assert_eq!(sets.len(), 44);
    let whites = |lighting| -> Vec<f64> {
        sets.iter().filter(|s| s.lighting == lighting).filter_map(|s| mean_of(s, 1, 0)).collect()
    };
    let (dark, bright) = (whites(LampSetting::Dark), whites(LampSetting::Bright));
    let (brightest, dimmest) =
        (dark.iter().fold(0.0, |a: f64, b| a.max(*b)), bright.iter().fold(255.0, |a: f64, b| a.min(*b)));
    assert!(brightest < dimmest, "Y of white: dark up to {brightest}, bright from {dimmest}");
    assert!(
        sets.iter().all(|set| set.pixel_variance.iter().all(|&v| v > 0.0) && set.degrees_of_freedom > 1e4)
    );
}

#[test]
fn some_colors_are_missing_and_counts_say_so() {
    let images: Vec<_> = sets().into_iter().flat_map(|set| set.images).collect();
    for color in 0..N_COLORS {
        let n_seen = images.iter().filter(|image| image.means[color].is_some()).count();
        assert!(n_seen > 60, "colour {color} in {n_seen} of 352 pictures");
        assert!(color < 2 || n_seen < 352, "colour {color} is always there");
    }
    assert!(images.iter().all(|i| i.means.iter().zip(i.counts).all(|(mean, n)| mean.is_some() == (n >= 30))));
}

#[test]
fn the_colors_of_a_hall_hang_together() {
    // Correlation between Y of green and of white over the halls of one light: what a joint prior lives on.
    let sets = sets();
    for lighting in [LampSetting::Dark, LampSetting::Bright] {
        let pairs: Vec<(f64, f64)> = sets
            .iter()
            .filter(|set| set.lighting == lighting)
            .filter_map(|set| Some((mean_of(set, 1, 1)?, mean_of(set, 4, 1)?)))
            .collect();
        let (a, b): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
        let product = mean(&pairs.iter().map(|(x, y)| (x - mean(&a)) * (y - mean(&b))).collect::<Vec<_>>());
        let correlation = product / (crate::support::deviation(&a) * crate::support::deviation(&b));
        println!(
            "{lighting:?}: correlation of U of white and pink {correlation:.2} over {} halls",
            pairs.len()
        );
        // With no correlation, 22 pairs exceed 0.54 with probability 0.5 %.
        assert!(correlation > 0.54, "{correlation}");
    }
}
