use crate::TrackingError;
use crate::error::{checked, probability};

/// Parameters of a [`HeadTracker`](super::HeadTracker).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct HeadTrackerParams {
    /// Bins of the axes $`B − G`$, $`G − R`$ and $`R + G + B`$. Default 32, 32, 8.
    pub color_bins: [usize; 3],
    /// With a fixed gradient weight: whether to use two modes, skin and hair, of variable proportion; otherwise one histogram. Default true.
    pub bimodal_colors: bool,
    /// Search radius around the predicted position, in semi-axes of the ellipse. Default 0.5.
    pub search_radius: f64,
    /// Factor between the three sizes that are compared. Default 1.04.
    pub scale_step: f64,
    /// Fixed weight of the gradient across the rim beside that of the colours; `None` weighs both by how well they distinguished the head from its
    /// surroundings in the last picture. Default `None`.
    pub gradient_weight: Option<f64>,
    /// Rate $`a`$ at which the colours adapt. [Andrade-Cetto 2005, Eq. 29] Default 0.1.
    pub color_adaptation_rate: f64,
    /// Intersection above which a lost head is found and, with a fixed gradient weight, the colours adapt; otherwise they adapt where an ellipse is
    /// likelier the head than its surroundings. Default 0.6.
    pub adapt_above_intersection: f64,
    /// Intersection below which there is no evidence of the head. Default 0.3.
    pub no_evidence_below_intersection: f64,
    /// Pictures in a row without evidence after which the head is lost. Default 8.
    pub lost_after_n_frames: usize,
}

impl Default for HeadTrackerParams {
    fn default() -> Self {
        Self {
            color_bins: [32, 32, 8],
            bimodal_colors: true,
            search_radius: 0.5,
            scale_step: 1.04,
            gradient_weight: None,
            color_adaptation_rate: 0.1,
            adapt_above_intersection: 0.6,
            no_evidence_below_intersection: 0.3,
            lost_after_n_frames: 8,
        }
    }
}

impl HeadTrackerParams {
    /// The published method: colours and gradient count equally [Birchfield 1998], and a head is never lost.
    pub fn as_published() -> Self {
        Self { gradient_weight: Some(0.5), no_evidence_below_intersection: 0.0, ..Self::default() }
    }

    pub(super) fn validate(&self) -> Result<(), TrackingError> {
        checked(
            "search_radius",
            self.search_radius,
            (0.05..=4.0).contains(&self.search_radius),
            "between 0.05 and 4",
        )?;
        let step = (1.0..=1.5).contains(&self.scale_step);
        checked("scale step", self.scale_step, step, "between 1 and 1.5")?;
        for (what, value) in [
            ("gradient weight", self.gradient_weight.unwrap_or(0.0)),
            ("color_adaptation_rate", self.color_adaptation_rate),
            ("intersection to adapt", self.adapt_above_intersection),
            ("no evidence below intersection", self.no_evidence_below_intersection),
        ] {
            probability(what, value)?;
        }
        Ok(())
    }
}
