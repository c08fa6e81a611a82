use wayfix_evaluation::report::Metric;
use wayfix_systems::views::DescriptorKind;

/// A scene's rows in the paper's tables; features in the order of [`DescriptorKind::OF_THE_PAPER`]. [Kasprzak & Szynkiewicz, Tables 1–3]
///
/// ```
/// use wayfix_experiments::PaperSceneRows;
/// use wayfix_systems::views::DescriptorKind;
/// let lift = PaperSceneRows::named("lift").expect("one of the four");
/// assert_eq!(lift.figure(DescriptorKind::Hist6, "successes"), Some(54.0));
/// assert_eq!(lift.figure(DescriptorKind::Joined, "successes"), None); // not in the paper
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperSceneRows {
    name: &'static str,
    between: [f64; 3],
    same: [[f64; 3]; 3],
    successes: [f64; 3],
}

impl PaperSceneRows {
    const ALL: [Self; 4] = [
        Self {
            name: "lift",
            between: [0.28396, 0.54611, 0.36141],
            same: [[0.2345, 0.7452, 0.1920], [0.9985, 0.9999, 0.9872], [0.8833, 0.9606, 0.7682]],
            successes: [89.0, 100.0, 54.0],
        },
        Self {
            name: "map",
            between: [0.42009, 0.71208, 0.88932],
            same: [[0.3015, 0.9322, 0.2643], [0.9999, 0.9999, 0.9943], [0.9429, 0.9856, 0.8953]],
            successes: [99.0, 100.0, 78.0],
        },
        Self {
            name: "all",
            between: [0.48502, 0.39076, 0.53752],
            same: [[0.1733, 0.1738, 0.1695], [0.9998, 0.9997, 0.9965], [0.8866, 0.9456, 0.8240]],
            successes: [99.0, 100.0, 71.0],
        },
        Self {
            name: "lab",
            between: [0.39041, 0.39442, 0.48202],
            same: [[0.5867, 0.5613, 0.5230], [0.9976, 0.9966, 0.9985], [0.9179, 0.9158, 0.8896]],
            successes: [87.0, 100.0, 51.0],
        },
    ];

    /// The scene of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|scene| scene.name == name)
    }

    /// The paper's value of a figure: `p_value_between_states_mean` (Table 1), `p_value_same_state_min`, `p_value_same_state_max`, `p_value_same_state_mean` (Table 2), `successes` (Table 3).
    pub fn figure(&self, feature: DescriptorKind, figure: &str) -> Option<f64> {
        let row = match figure {
            "p_value_between_states_mean" => &self.between,
            "p_value_same_state_min" => &self.same[0],
            "p_value_same_state_max" => &self.same[1],
            "p_value_same_state_mean" => &self.same[2],
            "successes" => &self.successes,
            _ => return None,
        };
        let column = DescriptorKind::OF_THE_PAPER.iter().position(|known| *known == feature)?;
        Some(row[column])
    }

    /// A figure of ours with the paper's beside it, if it has one.
    pub fn beside(&self, feature: DescriptorKind, metric: Metric) -> Metric {
        Metric { paper: self.figure(feature, &metric.name).or(metric.paper), ..metric }
    }
}
