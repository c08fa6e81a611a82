use super::{coverage::Coverage, outline::Outline, silhouette, view::ImagePoint, view::View};
use crate::{Camera, ColorId, Span, map::Prism, tree::Facet};

/// Draws convex things from front to back; what comes first stays.
#[derive(Clone, Debug)]
pub(super) struct Canvas {
    outline: Outline,
    coverage: Coverage,
}

impl Canvas {
    pub(super) fn new(camera: &Camera) -> Self {
        let (width, height) = (camera.width(), camera.height());
        Self { outline: Outline::new(width, height), coverage: Coverage::new(width, height) }
    }

    pub(super) fn clear(&mut self) {
        self.coverage.clear();
    }

    /// Draws a facet whose corners are in `points`; from the front its corners go counter-clockwise.
    pub(super) fn facet(
        &mut self,
        facet: &Facet,
        from_front: bool,
        points: &[ImagePoint],
        emit: &mut impl FnMut(Span),
    ) {
        let outside = facet.edges.iter().fold(u8::MAX, |bits, edge| bits & points[edge.corner].outside);
        if outside != 0 {
            return;
        }
        self.outline.clear();
        let mut corner = &points[facet.edges[facet.edges.len() - 1].corner];
        let mut line = facet.edges[facet.edges.len() - 1].line;
        for edge in &facet.edges {
            let next = &points[edge.corner];
            let (a, b) = (&points[line.0], &points[line.1]);
            self.outline.add((corner, next), if from_front { (b, a) } else { (a, b) });
            (corner, line) = (next, edge.line);
        }
        self.fill(facet.color, emit);
    }

    /// Draws a whole prism.
    pub(super) fn prism(&mut self, prism: &Prism, view: &View, emit: &mut impl FnMut(Span)) {
        if silhouette::trace(prism, view, &mut self.outline) {
            self.fill(prism.color, emit);
        }
    }

    fn fill(&mut self, color: ColorId, emit: &mut impl FnMut(Span)) {
        self.outline.trace();
        for (row, start, end) in self.outline.rows() {
            self.coverage.claim(row, start, end, |start, end| {
                emit(Span { row: row as u16, start: start as u16, end: end as u16, color });
            });
        }
    }
}
