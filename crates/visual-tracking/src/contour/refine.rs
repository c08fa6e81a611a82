use super::{ColorHypothesisAgreement, TrackingCues, hypotheses::candidate::Candidate, scene::Scene};
use crate::StructuringElement;
use crate::{ColorEdgeSearch, PixelMask, SnakeParams, TrackingError};

/// Overlap of contour and segmentation from which on both count as consistent.
pub(super) const COVERED: f64 = 0.7;

/// Accepted loss of area agreement by refinement.
const AREA_SLACK: f64 = 0.05;

impl Candidate {
    /// Refines the candidate on the image edges near the boundary of its mask: the snake fitted to $`∇I · \mathrm{dil}(∇S)`$. The candidate
    /// is unchanged if there is too little of an edge, or if the area would agree less.
    pub(super) fn refined(mut self, scene: &Scene<'_>, mask: &PixelMask) -> Self {
        let params = scene.params;
        if params.edge_search_distance == 0 || params.cues != TrackingCues::ColorAndShape {
            return self;
        }
        let band =
            mask.boundary().dilated(StructuringElement::Square { radius: params.edge_search_distance });
        let edges = ColorEdgeSearch::new(scene.picture, params.min_edge_contrast)
            .within(&band, scene.region.rect.corner());
        // The snake is where it belongs but for the width of the band.
        let near = SnakeParams { search_distance: 0.0, ..params.snake };
        let snake = &scene.reference.snake;
        let fit = snake.fit(&self.map, &edges, &near);
        let area = snake.area_at(&fit.map);
        let area_agrees =
            ColorHypothesisAgreement::of_areas(scene.expected_area, area) >= self.agreement.area - AREA_SLACK;
        if fit.support >= 0.5 * self.agreement.affine && area_agrees {
            (self.map, self.area) = (fit.map, area);
        }
        self
    }
}

impl Scene<'_> {
    /// Confidence in a candidate, from 0 to 1: the score of its agreement, reduced if contour and segmentation do not overlap.
    pub(super) fn confidence(&self, candidate: &Candidate, mask: &PixelMask) -> Result<f64, TrackingError> {
        let score = candidate.agreement.score(self.params);
        if self.params.cues != TrackingCues::ColorAndShape {
            return Ok(score);
        }
        Ok(score * (self.coverage(candidate, mask)? / COVERED).min(1.0))
    }

    /// Overlap of a candidate's contour and the segmentation.
    pub(super) fn coverage(&self, candidate: &Candidate, mask: &PixelMask) -> Result<f64, TrackingError> {
        let inside = self.region.inside(self.reference.snake.outline_at(&candidate.map)?.points())?;
        inside.iou(mask)
    }
}
