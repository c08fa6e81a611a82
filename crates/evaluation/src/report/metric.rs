use serde::{Deserialize, Serialize};

use crate::errors::MeanInterval;

/// One figure of a run with its bounds.
///
/// The verdict is not stored: `pass` in the JSON is computed on writing and ignored on reading.
/// ```
/// use wayfix_evaluation::report::Metric;
/// let ate = Metric::new("ate_aligned_rmse_m", 0.121, "m").at_most(0.164).bound_from("docs/accuracy.md");
/// assert!(ate.passes());
/// assert!(!Metric::new("nees_mean", f64::NAN, "").passes());
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "StoredMetric", into = "StoredMetric")]
pub struct Metric {
    /// Name with the unit in it, as in the contract: `ate_rmse_m`.
    pub name: String,
    /// Measured value; not finite if it could not be measured.
    pub value: f64,
    /// Unit for display, empty for plain numbers.
    pub unit: String,
    /// Uncertainty of the value, if it is a mean over seeds.
    pub spread: Option<ConfidenceInterval>,
    /// Smallest value that passes.
    pub low: Option<f64>,
    /// Largest value that passes.
    pub high: Option<f64>,
    /// Value in the paper.
    pub paper: Option<f64>,
    /// The best other program on the same data.
    pub peer: Option<PeerValue>,
    /// Source of the bounds: an argument, paper or peer.
    pub bound_source: Option<String>,
    /// Whether the bound is wanted and not reached yet: `bound_source` states it, and it does not count.
    pub open: bool,
}

/// The 95 % interval of a mean.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConfidenceInterval {
    /// The interval reaches this far to both sides.
    pub half_width: f64,
    /// Number of seeds.
    pub n: usize,
}

/// Value of another program on the same data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PeerValue {
    /// Its name and version.
    pub name: String,
    /// Its figure, in the unit of the metric.
    pub value: f64,
}

impl Metric {
    /// The figure `name`, without bounds.
    pub fn new(name: impl Into<String>, value: f64, unit: impl Into<String>) -> Self {
        Self { name: name.into(), value, unit: unit.into(), ..Self::default() }
    }
    /// A mean of samples, and half the width of its 95 % interval as the figure `name_ci95`.
    pub fn of_mean(name: &str, mean: &MeanInterval, unit: &str) -> [Self; 2] {
        let half_width = Self::new(format!("{name}_ci95"), mean.half_width, unit);
        [Self::new(name, mean.mean, unit), half_width]
    }
    /// The same with a smallest value that passes.
    pub fn at_least(self, low: f64) -> Self {
        Self { low: Some(low), ..self }
    }
    /// The same with a largest value that passes.
    pub fn at_most(self, high: f64) -> Self {
        Self { high: Some(high), ..self }
    }
    /// Sets the value in the paper.
    pub fn paper(self, value: f64) -> Self {
        Self { paper: Some(value), ..self }
    }
    /// The same with the best other program.
    pub fn peer(self, name: impl Into<String>, value: f64) -> Self {
        Self { peer: Some(PeerValue { name: name.into(), value }), ..self }
    }
    /// Sets the source of the bounds.
    pub fn bound_from(self, source: impl Into<String>) -> Self {
        Self { bound_source: Some(source.into()), ..self }
    }

    /// Whether the value is finite and within its bounds, both included. A NaN bound always fails.
    pub fn passes(&self) -> bool {
        self.value.is_finite()
            && self.low.is_none_or(|low| self.value >= low)
            && self.high.is_none_or(|high| self.value <= high)
    }
    /// Whether it could fail other than by not being finite.
    pub(crate) fn is_bounded(&self) -> bool {
        self.low.is_some() || self.high.is_some()
    }
}

/// A metric as stored in `report.json`. JSON has no NaN: such a value is `null`.
#[derive(Serialize, Deserialize)]
struct StoredMetric {
    name: String,
    value: Option<f64>,
    unit: String,
    low: Option<f64>,
    high: Option<f64>,
    paper: Option<f64>,
    #[serde(default)]
    pass: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    spread: Option<ConfidenceInterval>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    peer: Option<PeerValue>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    bound_source: Option<String>,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    open: bool,
}

impl From<Metric> for StoredMetric {
    fn from(metric: Metric) -> Self {
        let pass = metric.passes();
        let Metric { name, value, unit, spread, low, high, paper, peer, bound_source, open } = metric;
        let spread = spread.filter(|spread| spread.half_width.is_finite());
        let peer = peer.filter(|peer| peer.value.is_finite());
        Self {
            name,
            value: Some(value).filter(|value| value.is_finite()),
            unit,
            low,
            high,
            paper,
            pass,
            spread,
            peer,
            bound_source,
            open,
        }
    }
}

impl From<StoredMetric> for Metric {
    fn from(stored: StoredMetric) -> Self {
        let StoredMetric { name, value, unit, low, high, paper, pass: _, spread, peer, bound_source, open } =
            stored;
        Self {
            name,
            value: value.unwrap_or(f64::NAN),
            unit,
            spread,
            low,
            high,
            paper,
            peer,
            bound_source,
            open,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_included_and_everything_else_fails() {
        let bounded = |value| Metric::new("m", value, "").at_least(2.0).at_most(4.0).passes();
        assert!(bounded(2.0) && bounded(4.0) && bounded(3.0));
        assert!(!bounded(2.0f64.next_down()) && !bounded(4.0f64.next_up()));
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(!bounded(value) && !Metric::new("m", value, "").passes(), "{value}");
        }
        assert!(Metric::new("m", 1e300, "").passes());
        assert!(!Metric::new("m", 1.0, "").at_most(f64::NAN).passes());
        assert!(!Metric::new("m", 1.0, "").at_least(2.0).at_most(0.0).passes());
    }

    #[test]
    fn pass_cannot_be_written_by_hand() {
        let forged = r#"{"name":"m","value":9.0,"unit":"","low":null,"high":1.0,"paper":null,"pass":true}"#;
        let metric: Metric = serde_json::from_str(forged).unwrap();
        assert!(!metric.passes());
        assert_eq!(serde_json::to_value(&metric).unwrap()["pass"], false);
    }
}
