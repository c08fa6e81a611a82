use super::super::{ColorHypothesisAgreement, scene::Scene};
use crate::{
    AffineMap, ColorDistributionState, ColorEdgeSearch, MaskEdgeSearch, PixelConnectivity, PixelMask,
    TrackingCues,
};

/// Estimate of the target under a hypothesis about its colours.
#[derive(Clone, Copy, Debug)]
pub(in crate::contour) struct Candidate {
    pub(in crate::contour) map: AffineMap,
    pub(in crate::contour) area: f64,
    pub(in crate::contour) agreement: ColorHypothesisAgreement,
}

impl Candidate {
    /// Weighs a hypothesis: histogram, segmentation, morphology, blob, snake, agreement.
    pub(in crate::contour) fn of_colors(scene: &Scene<'_>, state: &ColorDistributionState) -> Self {
        match scene.target_mask(&scene.bin_set(state)) {
            Some(mask) => Self::of_mask(scene, &scene.start, &mask),
            None => Self { map: scene.start, area: 0.0, agreement: ColorHypothesisAgreement::NONE },
        }
    }

    /// Scores a segmentation of the target, with the snake fitted from a start.
    pub(in crate::contour) fn of_mask(scene: &Scene<'_>, start: &AffineMap, mask: &PixelMask) -> Self {
        let params = scene.params;
        let (map, area, affine) = match params.cues {
            TrackingCues::Color => {
                let area = mask.area() as f64;
                (blob_map(scene, mask, area), area, 1.0)
            }
            _ => {
                let snake = &scene.reference.snake;
                let edges = MaskEdgeSearch::new(mask, scene.region.rect.corner());
                let fit = snake.fit(start, &edges, &params.snake);
                (fit.map, snake.area_at(&fit.map), fit.support * in_sight(fit.visible))
            }
        };
        let agreement = ColorHypothesisAgreement {
            affine,
            area: ColorHypothesisAgreement::of_areas(scene.expected_area, area),
            quality: ColorHypothesisAgreement::of_euler_number(
                mask.euler_number(PixelConnectivity::Eight),
                params.max_euler_number_deviation,
            ),
        };
        Self { map, area, agreement }
    }

    /// Without colours: the snake on the edges of the picture.
    pub(in crate::contour) fn of_edges(scene: &Scene<'_>) -> Self {
        let (params, snake) = (scene.params, &scene.reference.snake);
        let edges = ColorEdgeSearch::new(scene.picture, params.min_edge_contrast);
        let fit = snake.fit(&scene.start, &edges, &params.snake);
        let area = snake.area_at(&fit.map);
        let agreement = ColorHypothesisAgreement {
            affine: fit.support * in_sight(fit.visible),
            area: ColorHypothesisAgreement::of_areas(scene.expected_area, area),
            quality: 1.0,
        };
        Self { map: fit.map, area, agreement }
    }
}

/// Weight of the visible share of the contour: 1 from one half on, decreasing to 0 below that.
fn in_sight(visible: f64) -> f64 {
    (2.0 * visible).min(1.0)
}

/// The last place, moved to the middle of a blob and scaled to its area.
fn blob_map(scene: &Scene<'_>, mask: &PixelMask, area: f64) -> AffineMap {
    let last = scene.reference.snake.map();
    let scale = (area / scene.reference.snake.area_at(last)).sqrt();
    match mask.centroid() {
        Some([u, v]) if scale > 0.0 => {
            let corner = scene.region.rect.corner();
            AffineMap {
                linear: last.linear * scale,
                translation: [u + corner.0 as f64, v + corner.1 as f64].into(),
            }
        }
        _ => *last,
    }
}
