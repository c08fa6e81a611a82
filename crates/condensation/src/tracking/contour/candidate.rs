use super::{Agreement, scene::Scene};
use crate::{
    AffineMap, BitMask, ColorEdges, ColorState, CondensationError, Connectivity, MaskEdges, TrackingCues,
};

/// Where the target would be if a hypothesis about its colours were true.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) map: AffineMap,
    pub(super) area: f64,
    pub(super) agreement: Agreement,
}

impl Candidate {
    /// Weighs a hypothesis: histogram, segmentation, morphology, blob, snake, agreement.
    pub(super) fn of_colors(scene: &Scene<'_>, state: &ColorState) -> Self {
        match scene.target_mask(&scene.bin_set(state)) {
            Some(mask) => Self::of_mask(scene, &scene.start, &mask),
            None => Self { map: scene.start, area: 0.0, agreement: Agreement::NONE },
        }
    }

    /// Weighs a segmentation of the target, with the snake laid on a start.
    pub(super) fn of_mask(scene: &Scene<'_>, start: &AffineMap, mask: &BitMask) -> Self {
        let params = scene.params;
        let (map, area, affine) = match params.cues {
            TrackingCues::Color => {
                let area = mask.area() as f64;
                (blob_map(scene, mask, area), area, 1.0)
            }
            _ => {
                let snake = &scene.reference.snake;
                let edges = MaskEdges::new(mask, scene.region.rect.corner());
                let fit = snake.fit(start, &edges, &params.snake);
                (fit.map, snake.area_at(&fit.map), fit.support * in_sight(fit.visible))
            }
        };
        let agreement = Agreement {
            affine,
            area: Agreement::of_areas(scene.expected_area, area),
            quality: Agreement::of_euler_number(mask.euler_number(Connectivity::Eight), params.euler_range),
        };
        Self { map, area, agreement }
    }

    /// Without colours: the snake on the edges of the picture.
    pub(super) fn of_edges(scene: &Scene<'_>) -> Self {
        let (params, snake) = (scene.params, &scene.reference.snake);
        let edges = ColorEdges::new(scene.picture, params.edge_contrast);
        let fit = snake.fit(&scene.start, &edges, &params.snake);
        let area = snake.area_at(&fit.map);
        let agreement = Agreement {
            affine: fit.support * in_sight(fit.visible),
            area: Agreement::of_areas(scene.expected_area, area),
            quality: 1.0,
        };
        Self { map: fit.map, area, agreement }
    }

    /// The candidate on the edges of the picture near the boundary of its mask: the snake fitted to $`∇I · \mathrm{dil}(∇S)`$. Where there is
    /// too little of an edge, or the area would agree less, it stays as it is.
    pub(super) fn refined(mut self, scene: &Scene<'_>, mask: &BitMask) -> Self {
        let params = scene.params;
        if params.band_radius == 0 || params.cues != TrackingCues::ColorAndShape {
            return self;
        }
        let band = scene.band_of(mask);
        let edges =
            ColorEdges::new(scene.picture, params.edge_contrast).within(&band, scene.region.rect.corner());
        // The snake is where it belongs but for the width of the band.
        let near = crate::SnakeParams { reach: 0.0, ..params.snake };
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
    pub(super) fn confidence(&self, candidate: &Candidate, mask: &BitMask) -> Result<f64, CondensationError> {
        let score = candidate.agreement.score(self.params);
        if self.params.cues != TrackingCues::ColorAndShape {
            return Ok(score);
        }
        let inside = self.region.inside(self.reference.snake.outline_at(&candidate.map)?.points())?;
        Ok(score * (inside.iou(mask)? / COVERED).min(1.0))
    }
}

/// Overlap of contour and segmentation from which on nothing speaks against either.
const COVERED: f64 = 0.7;

/// How much worse the area may agree after refinement.
const AREA_SLACK: f64 = 0.05;

/// What is out of the picture supports nothing: from half of the contour in sight on it costs nothing, below that everything, gradually.
fn in_sight(visible: f64) -> f64 {
    (2.0 * visible).min(1.0)
}

/// The last place, moved to the middle of a blob and scaled to its area.
fn blob_map(scene: &Scene<'_>, mask: &BitMask, area: f64) -> AffineMap {
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
