/// Scale of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AxisScale {
    /// Equal differences, equal distances.
    #[default]
    Linear,
    /// Equal ratios, equal distances; numbers that are not positive leave a gap.
    Log10,
}

impl AxisScale {
    /// Position on the scale; `None` if the value cannot be drawn.
    fn apply(self, value: f64) -> Option<f64> {
        let scaled = match self {
            Self::Linear => value,
            Self::Log10 if value > 0.0 => value.log10(),
            Self::Log10 => return None,
        };
        // Differences of larger values could overflow.
        (scaled.abs() < 1e150).then_some(scaled)
    }
}

/// A range of numbers and how they are spaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::plot) struct Axis {
    scale: AxisScale,
    /// Ends on the scale (logarithms for a logarithmic one).
    low: f64,
    high: f64,
}

impl Axis {
    /// The axis that covers every drawable value with `padding` (a share of the range) on both sides; `None` without values.
    pub(in crate::plot) fn covering(
        values: impl IntoIterator<Item = f64>,
        scale: AxisScale,
        padding: f64,
    ) -> Option<Self> {
        let (low, high) = values
            .into_iter()
            .filter_map(|value| scale.apply(value))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        if low > high {
            return None;
        }
        let margin = padding * (high - low);
        // A constant, or a range too narrow for its own digits, still deserves an axis.
        let least = if low == 0.0 && high == 0.0 { 1.0 } else { 1e-9 * low.abs().max(high.abs()) };
        let margin = if high - low > least { margin } else { least.max(0.05 * low.abs()) };
        Some(Self { scale, low: low - margin, high: high + margin })
    }

    /// The linear axis from `low` to `high`, as they are.
    pub(in crate::plot) fn linear(low: f64, high: f64) -> Self {
        Self { scale: AxisScale::Linear, low, high }
    }

    /// Relative position of `value`: 0 at the low end, 1 at the high end; `None` if it cannot be drawn.
    pub(in crate::plot) fn fraction(&self, value: f64) -> Option<f64> {
        Some((self.scale.apply(value)? - self.low) / (self.high - self.low))
    }

    /// The values at both ends.
    pub(in crate::plot) fn ends(&self) -> (f64, f64) {
        match self.scale {
            AxisScale::Linear => (self.low, self.high),
            AxisScale::Log10 => (10f64.powf(self.low), 10f64.powf(self.high)),
        }
    }

    /// About `count` round numbers on the axis with their labels.
    pub(in crate::plot) fn ticks(&self, count: usize) -> Vec<(f64, String)> {
        match self.scale {
            AxisScale::Linear => self.linear_ticks(count),
            AxisScale::Log10 => self.decade_ticks(count),
        }
    }

    fn linear_ticks(&self, count: usize) -> Vec<(f64, String)> {
        let step = round_step((self.high - self.low) / count.max(1) as f64);
        let decimals = (-step.log10().floor()).max(0.0) as usize;
        let scientific = decimals > 5 || self.low.abs().max(self.high.abs()) >= 1e6;
        multiples(step, self.low, self.high)
            .map(|tick| {
                let label = if scientific { format!("{tick:.1e}") } else { format!("{tick:.decimals$}") };
                (tick, label.replace('-', "−"))
            })
            .collect()
    }

    fn decade_ticks(&self, count: usize) -> Vec<(f64, String)> {
        let decades = self.high - self.low;
        if decades < 1.0 {
            // Too short for decades: round numbers of the values themselves.
            let (low, high) = self.ends();
            return Self::linear(low, high).linear_ticks(count);
        }
        let mantissas: &[f64] = if decades < 2.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let stride = (decades / count.max(1) as f64).ceil().max(1.0);
        multiples(stride, self.low.floor(), self.high)
            .flat_map(|decade| mantissas.iter().map(move |mantissa| (decade, *mantissa)))
            .filter(|(decade, mantissa)| (self.low..=self.high).contains(&(decade + mantissa.log10())))
            .map(|(decade, mantissa)| (mantissa * 10f64.powf(decade), decade_label(decade as i32, mantissa)))
            .collect()
    }
}

/// The multiples of `step` from `low` to `high`, at most a hundred of them.
fn multiples(step: f64, low: f64, high: f64) -> impl Iterator<Item = f64> {
    let first = (low / step).ceil();
    let count = ((high / step).floor() - first).clamp(-1.0, 99.0) as i64 + 1;
    (0..count).map(move |k| (first + k as f64) * step + 0.0)
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `rough`.
fn round_step(rough: f64) -> f64 {
    let power = 10f64.powf(rough.log10().floor());
    let mantissa = rough / power;
    power * [1.0, 2.0, 5.0].into_iter().find(|step| mantissa <= step * (1.0 + 1e-9)).unwrap_or(10.0)
}

fn decade_label(decade: i32, mantissa: f64) -> String {
    if (-3..=4).contains(&decade) {
        let decimals = (-decade).max(0) as usize;
        return format!("{:.decimals$}", mantissa * 10f64.powi(decade));
    }
    const SUPERSCRIPTS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digits = decade.unsigned_abs().to_string();
    let exponent: String =
        digits.chars().filter_map(|c| c.to_digit(10)).map(|d| SUPERSCRIPTS[d as usize]).collect();
    let sign = if decade < 0 { "⁻" } else { "" };
    let factor = if mantissa == 1.0 { String::new() } else { format!("{mantissa}·") };
    format!("{factor}10{sign}{exponent}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: Axis, count: usize) -> Vec<String> {
        axis.ticks(count).into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round_numbers_inside_the_axis() {
        assert_eq!(labels(Axis::linear(-0.31, 0.33), 5), ["−0.2", "0.0", "0.2"]);
        assert_eq!(labels(Axis::linear(3.0, 97.0), 5), ["20", "40", "60", "80"]);
        let decades = Axis::covering([0.002, 30.0], AxisScale::Log10, 0.0).unwrap();
        assert_eq!(labels(decades, 6), ["0.01", "0.1", "1", "10"]);
    }

    #[test]
    fn any_numbers_give_an_axis_that_places_them() {
        for values in [
            vec![0.0],
            vec![7.0],
            vec![-1e-12, 1e-12],
            vec![1e149, -1e149],
            vec![f64::NAN, 2.0, f64::INFINITY],
        ] {
            let axis = Axis::covering(values.iter().copied(), AxisScale::Linear, 0.05).unwrap();
            let finite: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
            assert!(
                finite.iter().all(|value| (0.0..=1.0).contains(&axis.fraction(*value).unwrap())),
                "{finite:?}"
            );
            assert!(!axis.ticks(5).is_empty(), "{finite:?}");
        }
        assert_eq!(Axis::covering([f64::NAN], AxisScale::Linear, 0.1), None);
        assert_eq!(Axis::covering([0.0, -3.0], AxisScale::Log10, 0.1), None);
    }
}
