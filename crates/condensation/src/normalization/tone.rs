use image::RgbImage;

use crate::features::picture::rgb_pixels;

/// A share of pixels for each of the 256 values.
type Shares = [f64; 256];

fn shares(picture: &RgbImage, channel: usize) -> Shares {
    let mut counts = [0_u64; 256];
    let pixels = rgb_pixels(picture);
    for pixel in pixels {
        counts[usize::from(pixel[channel])] += 1;
    }
    counts.map(|count| count as f64 / pixels.len() as f64)
}

/// The share of darker pixels and half of those that are equal.
fn middle_ranks(shares: &Shares) -> [f64; 256] {
    let mut darker = 0.0;
    shares.map(|share| {
        darker += share;
        darker - 0.5 * share
    })
}

/// Where a rank falls among those of the 256 values.
fn value_at(rank: f64, ranks: &[f64; 256]) -> f64 {
    let above = ranks.partition_point(|&other| other < rank);
    if above == 0 || above == 256 {
        return above.min(255) as f64;
    }
    let (low, high) = (ranks[above - 1], ranks[above]);
    (above - 1) as f64 + if high > low { (rank - low) / (high - low) } else { 0.0 }
}

/// The [`LightChange`](crate::LightChange) in which `learned` matches `seen`, by least squares between the quantiles of all three channels; for
/// [`LightChange::inverse_table`](crate::LightChange::inverse_table).
///
/// One curve for all channels: three numbers from the whole scene cannot follow objects that leave the view, as a matched histogram would.
/// None when the learned scene has no contrast.
///
/// ```
/// use wayfix_condensation::{LightChange, RgbImage, light_match};
/// let bytes = (0..=255).flat_map(|grey| [grey; 3]).collect();
/// let learned = RgbImage::from_raw(16, 16, bytes).expect("3 bytes a pixel");
/// let light = LightChange { gain: 0.7, offset: 20.0, gamma: 1.3 };
/// let found = light_match(&light.apply(&learned)?, &learned).expect("contrast");
/// assert!((found.gain - 0.7).abs() < 0.01 && (found.offset - 20.0).abs() < 1.0 && (found.gamma - 1.3).abs() < 0.02);
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
pub fn light_match(seen: &RgbImage, learned: &RgbImage) -> Option<crate::LightChange> {
    let pairs: Vec<(f64, f64)> = (0..3)
        .flat_map(|channel| {
            let ranks = middle_ranks(&shares(seen, channel));
            let learned_ranks = middle_ranks(&shares(learned, channel));
            (1..100).map(move |i| {
                let rank = f64::from(i) / 100.0;
                (value_at(rank, &learned_ranks), value_at(rank, &ranks))
            })
        })
        .collect();
    // Given gamma the rest is a line; gamma itself is tried from 0.4 to 2.5 in steps of one per cent.
    let fits = (-92..=92).filter_map(|i| fit_line(&pairs, 1.01_f64.powi(i)));
    fits.min_by(|a, b| a.1.total_cmp(&b.1)).map(|fit| fit.0)
}

/// Gain and offset for a gamma, and the squared error.
fn fit_line(pairs: &[(f64, f64)], gamma: f64) -> Option<(crate::LightChange, f64)> {
    let n = pairs.len() as f64;
    let bent = |value: f64| 255.0 * (value / 255.0).powf(gamma);
    let x_mean = pairs.iter().map(|pair| bent(pair.0)).sum::<f64>() / n;
    let y_mean = pairs.iter().map(|pair| pair.1).sum::<f64>() / n;
    let (mut xx, mut xy) = (0.0, 0.0);
    for &(x, y) in pairs {
        xx += (bent(x) - x_mean).powi(2);
        xy += (bent(x) - x_mean) * (y - y_mean);
    }
    let gain = xy / xx;
    let offset = y_mean - gain * x_mean;
    let error = pairs.iter().map(|&(x, y)| (gain * bent(x) + offset - y).powi(2)).sum();
    (xx > 0.0 && gain > 0.0).then_some((crate::LightChange { gain, offset, gamma }, error))
}
