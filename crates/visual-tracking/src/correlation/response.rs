/// The highest place of a response over shifts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Peak {
    /// Shift in cells, to a fraction of a cell.
    pub(super) shift: [f64; 2],
    /// The response there.
    pub(super) value: f64,
    /// Height of the peak above the mean of the rest, in standard deviations of the rest. [Bolme et al. 2010, sec. 3.5]
    pub(super) peak_to_sidelobe: f64,
}

/// Half the side of the square around a peak that does not count as rest, in cells.
const OWN: usize = 4;

impl Peak {
    /// Of a square response, shift zero at the top left, negative shifts at the far ends.
    pub(super) fn of(response: &[f32], side: usize) -> Self {
        let best = (0..response.len()).max_by(|&a, &b| response[a].total_cmp(&response[b]).then(b.cmp(&a)));
        let best = best.unwrap_or(0);
        let (x, y) = (best % side, best / side);
        let at = |dx: usize, dy: usize| f64::from(response[((y + dy) % side) * side + (x + dx) % side]);
        let value = at(0, 0);
        let signed = |i: usize| if i > side / 2 { i as f64 - side as f64 } else { i as f64 };
        let shift = [
            signed(x) + vertex(at(side - 1, 0), value, at(1, 0)),
            signed(y) + vertex(at(0, side - 1), value, at(0, 1)),
        ];
        Self { shift, value, peak_to_sidelobe: peak_to_sidelobe(response, side, (x, y), value) }
    }
}

/// Maximum of a Gaussian through three values at −1, 0, 1 with the largest in the middle; of a parabola if a value is not positive. A
/// parabola underestimates the offset by a fifth, which would accumulate because every image is learned at its estimate.
pub(super) fn vertex(before: f64, at: f64, after: f64) -> f64 {
    let [before, at, after] =
        if before.min(after) > 0.0 { [before, at, after].map(libm::log) } else { [before, at, after] };
    let bend = before - 2.0 * at + after;
    if bend < 0.0 { (0.5 * (before - after) / bend).clamp(-0.5, 0.5) } else { 0.0 }
}

fn peak_to_sidelobe(response: &[f32], side: usize, (x, y): (usize, usize), value: f64) -> f64 {
    let apart = |a: usize, b: usize| a.abs_diff(b).min(side - a.abs_diff(b));
    let (mut n, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for (i, &v) in response.iter().enumerate() {
        if apart(i % side, x) > OWN || apart(i / side, y) > OWN {
            let v = f64::from(v);
            n += 1.0;
            sum += v;
            squares += v * v;
        }
    }
    let mean = sum / f64::max(n, 1.0);
    let deviation = (squares / f64::max(n, 1.0) - mean * mean).max(0.0).sqrt();
    if deviation > 1e-9 { (value - mean) / deviation } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn the_top_of_a_gaussian_is_found_between_its_values() {
        for top in [-0.4, -0.1, 0.0, 0.3, 0.45] {
            let value = |x: f64| (-0.5 * (x - top).powi(2) / 0.64).exp();
            assert_abs_diff_eq!(vertex(value(-1.0), value(0.0), value(1.0)), top, epsilon = 1e-12);
        }
        assert_eq!(vertex(0.0, 0.0, 0.0), 0.0);
        assert_abs_diff_eq!(vertex(-2.0, 2.0, 0.0), 1.0 / 6.0, epsilon = 1e-12); // the parabola 2 + x − 3 x²
    }

    #[test]
    fn shifts_beyond_half_the_side_are_negative() {
        let mut response = vec![0.0; 144];
        response[11 * 12 + 2] = 1.0;
        let peak = Peak::of(&response, 12);
        assert_eq!((peak.shift, peak.value), ([2.0, -1.0], 1.0));
        assert_eq!(Peak::of(&[0.0; 144], 12).peak_to_sidelobe, 0.0);
    }
}
