use super::{Agreement, TrackingCues, hypotheses::candidate::Candidate, scene::Scene};
use crate::Element;
use crate::{BitMask, ColorEdges, SnakeParams, TrackingError};

/// Overlap of contour and segmentation from which on nothing speaks against either.
pub(super) const COVERED: f64 = 0.7;

/// How much worse the area may agree after refinement.
const AREA_SLACK: f64 = 0.05;

impl Candidate {
    /// The candidate on the edges of the picture near the boundary of its mask: the snake fitted to $`∇I · \mathrm{dil}(∇S)`$. Where there is
    /// too little of an edge, or the area would agree less, it stays as it is.
    pub(super) fn refined(mut self, scene: &Scene<'_>, mask: &BitMask) -> Self {
        let params = scene.params;
        if params.band_radius == 0 || params.cues != TrackingCues::ColorAndShape {
            return self;
        }
        let band = mask.boundary().dilated(Element::Square { radius: params.band_radius });
        let edges =
            ColorEdges::new(scene.picture, params.edge_contrast).within(&band, scene.region.rect.corner());
        // The snake is where it belongs but for the width of the band.
        let near = SnakeParams { search_distance: 0.0, ..params.snake };
        let snake = &scene.reference.snake;
        let fit = snake.fit(&self.map, &edges, &near);
        let area = snake.area_at(&fit.map);
        let area_agrees = Agreement::of_areas(scene.expected_area, area) >= self.agreement.area - AREA_SLACK;
        if fit.support >= 0.5 * self.agreement.affine && area_agrees {
            (self.map, self.area) = (fit.map, area);
        }
        self
    }
}

impl Scene<'_> {
    /// How sure one can be that the target is where a candidate says, from 0 to 1: the score of its agreement, less where the contour and the
    /// segmentation do not cover each other.
    pub(super) fn confidence(&self, candidate: &Candidate, mask: &BitMask) -> Result<f64, TrackingError> {
        let score = candidate.agreement.score(self.params);
        if self.params.cues != TrackingCues::ColorAndShape {
            return Ok(score);
        }
        Ok(score * (self.coverage(candidate, mask)? / COVERED).min(1.0))
    }

    /// Overlap of a candidate's contour and the segmentation.
    pub(super) fn coverage(&self, candidate: &Candidate, mask: &BitMask) -> Result<f64, TrackingError> {
        let inside = self.region.inside(self.reference.snake.outline_at(&candidate.map)?.points())?;
        inside.iou(mask)
    }
}
