use crate::error::{checked, probability};
use crate::{ColorQuantizer, ColorSpace, CondensationError};

/// How [`MeanShift`](crate::MeanShift) follows its target.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct MeanShiftParams {
    /// The space of the colours.
    pub space: ColorSpace,
    /// Bins of each axis.
    pub bins: [usize; 3],
    /// Moves of the window in a picture at most.
    pub max_iterations: usize,
    /// A shorter move is the last one, pixels.
    pub tolerance: f64,
    /// How far beyond the window its size is measured, as a share of its sides.
    pub margin: f64,
    /// How much the window may grow or shrink from one picture to the next, as a factor; 1 for a window of fixed size.
    pub growth: f64,
    /// Below this share of the contrast of colour at the start the target is lost.
    pub lost_below: f64,
    /// From this share on it is found again.
    pub found_above: f64,
}

impl Default for MeanShiftParams {
    /// The paper's colours, OpenCV's ten moves of a pixel at least; a window that follows a target which doubles its size in 8 pictures; lost
    /// when 7 tenths of the colour are gone, found when half of it is back.
    fn default() -> Self {
        Self {
            space: ColorSpace::Opponent,
            bins: [32, 32, 8],
            max_iterations: 10,
            tolerance: 1.0,
            margin: 0.2,
            growth: 1.1,
            lost_below: 0.3,
            found_above: 0.5,
        }
    }
}

impl MeanShiftParams {
    /// The quantizer that the parameters describe, if all of them are in their ranges.
    pub(super) fn quantizer(&self) -> Result<ColorQuantizer, CondensationError> {
        let tolerance = self.tolerance;
        checked("tolerance of mean shift", tolerance, tolerance > 0.0, "positive")?;
        checked("iterations of mean shift", self.max_iterations as f64, self.max_iterations > 0, "positive")?;
        checked("margin of a window", self.margin, (0.0..=1.0).contains(&self.margin), "between 0 and 1")?;
        checked("growth of a window", self.growth, (1.0..=2.0).contains(&self.growth), "between 1 and 2")?;
        probability("share at which a target is lost", self.lost_below)?;
        let above = (self.lost_below..=1.0).contains(&self.found_above);
        checked(
            "share at which a target is found",
            self.found_above,
            above,
            "between the share of loss and 1",
        )?;
        ColorQuantizer::new(self.space, self.bins)
    }
}
