use super::{coverage::Coverage, outline::Outline, silhouette, view::ImagePoint, view::View};
use crate::{ColorId, PinholeCamera, PixelSpan, map::Prism, tree::Facet};

/// Draws convex shapes from front to back; drawn pixels are not overwritten.
#[derive(Clone, Debug)]
pub(super) struct Canvas {
    outline: Outline,
    coverage: Coverage,
    corners: Vec<ImagePoint>,
}

impl Canvas {
    pub(super) fn new(camera: &PinholeCamera) -> Self {
        let (width, height) = (camera.width(), camera.height());
        Self {
            outline: Outline::new(width, height),
            coverage: Coverage::new(width, height),
            corners: Vec::new(),
        }
    }

    pub(super) fn clear(&mut self) {
        self.coverage.clear();
    }

    /// Draws a facet, seen from the front or from the back of its plane.
    pub(super) fn facet(
        &mut self,
        facet: &Facet,
        from_front: bool,
        view: &View,
        emit: &mut impl FnMut(PixelSpan),
    ) {
        if view.misses(&facet.center, facet.radius) {
            return;
        }
        self.corners.clear();
        self.corners.extend(facet.edges.iter().map(|edge| view.point(&edge.corner)));
        if view.is_beside(&self.corners) {
            return;
        }
        self.outline.clear();
        let ends = self.corners.iter().zip(self.corners.iter().cycle().skip(1));
        for (edge, (corner, next)) in facet.edges.iter().zip(ends) {
            let whole = edge.whole.map(|(a, b)| (view.point(&a), view.point(&b)));
            let (a, b) = whole.as_ref().map_or((corner, next), |(a, b)| (a, b));
            self.outline.add((corner, next), if from_front { (b, a) } else { (a, b) });
        }
        self.fill(facet.color, emit);
    }

    /// Draws a whole prism.
    pub(super) fn prism(&mut self, prism: &Prism, view: &View, emit: &mut impl FnMut(PixelSpan)) {
        silhouette::trace(prism, view, &mut self.outline);
        self.fill(prism.color, emit);
    }

    fn fill(&mut self, color: ColorId, emit: &mut impl FnMut(PixelSpan)) {
        self.outline.trace();
        for (row, start, end) in self.outline.rows() {
            self.coverage.claim(row, start, end, |start, end| {
                emit(PixelSpan { row: row as u16, start: start as u16, end: end as u16, color });
            });
        }
    }
}
