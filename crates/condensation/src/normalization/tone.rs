use crate::Picture;

/// Tables that give each channel of `seen` the mean and standard deviation of `learned`.
pub fn affine_match(seen: &Picture, learned: &Picture) -> [[u8; 256]; 3] {
    std::array::from_fn(|channel| {
        let (m, s) = moments(&histogram(seen, channel));
        let (mean, sigma) = moments(&histogram(learned, channel));
        let gain = if s > 0.0 { sigma / s } else { 1.0 };
        std::array::from_fn(|i| ((i as f64 - m) * gain + mean).round().clamp(0.0, 255.0) as u8)
    })
}

/// Tables that give each channel of `seen` the histogram of `learned`.
pub fn histogram_match(seen: &Picture, learned: &Picture) -> [[u8; 256]; 3] {
    std::array::from_fn(|channel| {
        let a = mid_ranks(&histogram(seen, channel));
        let b = mid_ranks(&histogram(learned, channel));
        std::array::from_fn(|i| interpolate(a[i], &b).round().clamp(0.0, 255.0) as u8)
    })
}

fn histogram(picture: &Picture, channel: usize) -> [f64; 256] {
    let mut h = [0.0; 256];
    for p in picture.pixels() {
        h[usize::from(p[channel])] += 1.0;
    }
    h.map(|c| c / picture.pixels().len() as f64)
}

fn moments(h: &[f64; 256]) -> (f64, f64) {
    let mean: f64 = h.iter().enumerate().map(|(i, p)| i as f64 * p).sum();
    let var: f64 = h.iter().enumerate().map(|(i, p)| (i as f64 - mean).powi(2) * p).sum();
    (mean, var.sqrt())
}

fn mid_ranks(h: &[f64; 256]) -> [f64; 256] {
    let mut sum = 0.0;
    h.map(|p| {
        sum += p;
        sum - 0.5 * p
    })
}

fn interpolate(rank: f64, ranks: &[f64; 256]) -> f64 {
    let above = ranks.partition_point(|&r| r < rank);
    if above == 0 {
        return 0.0;
    }
    if above == 256 {
        return 255.0;
    }
    let (lo, hi) = (ranks[above - 1], ranks[above]);
    (above - 1) as f64 + if hi > lo { (rank - lo) / (hi - lo) } else { 0.0 }
}
