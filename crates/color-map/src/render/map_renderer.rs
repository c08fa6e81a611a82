use std::sync::Arc;

use wayfix_estimation_traits::Pose3;

use super::{canvas::Canvas, margin::Margin, pose, view::View};
use crate::{
    ColorMap, LabelImage, PinholeCamera, PixelSpan, RenderError,
    map::{PLANE_TOLERANCE_M, Prism},
    tree::{Face, Node, Solid},
};

/// Renders a map for one camera.
///
/// Surfaces are drawn from front to back and a pixel belongs to the first one that covers its centre, so the cost depends on the visible edges and
/// spans. The result equals [`ColorMap::cast`] through every pixel's centre, up to rounding: they may differ only if that ray passes within about
/// 1e-9 of its length of an edge, or of the line where two surfaces meet. Only sums, products, quotients and square roots are used, so the spans of
/// a pose are equal on every machine.
///
/// It reuses its buffers between views, so create one per thread.
/// ```
/// use std::sync::Arc;
/// use nalgebra::Vector3;
/// use wayfix_color_map::{PinholeCamera, ColorId, ColorMap, MapRenderer, ColoredShape, PixelSpan};
/// use wayfix_estimation_traits::{LieGroup, Pose3};
///
/// let vertices = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[y, z]| Vector3::new(2.0, y, z)).to_vec();
/// let wall = ColoredShape::Polygon { color: ColorId(0), vertices };
/// let map = Arc::new(ColorMap::new(vec!["white".into()], vec![wall])?);
/// let mut renderer = MapRenderer::new(map, PinholeCamera::new(4, 2, 1.0, 1.0, 2.0, 1.0)?);
/// let mut spans = Vec::new();
/// renderer.spans(&Pose3::identity(), &mut |span| spans.push(span))?;
/// // Half a pixel to either side of the middle, and pixel centres at the very edge belong to what is right of it and below.
/// assert_eq!(spans, [PixelSpan { row: 0, start: 1, end: 2, color: ColorId(0) }]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct MapRenderer {
    map: Arc<ColorMap>,
    camera: PinholeCamera,
    canvas: Canvas,
    todo: Vec<Step>,
    standing: Vec<Standing>,
    /// Created on first use.
    margin: Option<Margin>,
}

/// A pending step; the nearest is last.
#[derive(Clone, Copy, Debug)]
enum Step {
    /// A subtree.
    Tree(usize),
    /// The facets of a node, seen from the front or from the back.
    Facets(usize, bool),
}

/// A solid of a leaf with its sort key: only a solid with a smaller key may hide it.
#[derive(Clone, Copy, Debug)]
struct Standing {
    /// Power of the eye's foot with respect to the prism's circle.
    power: f64,
    /// Vertical distance from the eye to the solid, for bands of one post.
    gap: f64,
    solid: usize,
}

impl MapRenderer {
    /// For one map and camera.
    pub fn new(map: Arc<ColorMap>, camera: PinholeCamera) -> Self {
        Self {
            map,
            camera,
            canvas: Canvas::new(&camera),
            todo: Vec::new(),
            standing: Vec::new(),
            margin: None,
        }
    }

    /// The map.
    pub fn map(&self) -> &ColorMap {
        &self.map
    }

    /// The camera.
    pub fn camera(&self) -> &PinholeCamera {
        &self.camera
    }

    /// Emits every pixel that shows a map colour exactly once, in spans in any order.
    ///
    /// `camera_pose` is the camera's in the world: x forward, y left, z up.
    /// # Errors
    /// Returns [`RenderError::Pose`] if the pose is not finite, farther than 1e6 m away, or its quaternion not of unit length. Nothing is emitted then.
    pub fn spans(
        &mut self,
        camera_pose: &Pose3<f64>,
        emit: &mut impl FnMut(PixelSpan),
    ) -> Result<(), RenderError> {
        pose::check(camera_pose)?;
        let Self { map, camera, canvas, todo, standing, .. } = self;
        let view = View::new(camera, camera_pose);
        let tree = &map.tree;
        canvas.clear();
        todo.clear();
        todo.push(Step::Tree(tree.root));
        while let Some(step) = todo.pop() {
            let index = match step {
                Step::Tree(index) => index,
                Step::Facets(index, from_front) => {
                    if let Node::Split { facets, .. } = &tree.nodes[index] {
                        facets.iter().for_each(|facet| canvas.facet(facet, from_front, &view, emit));
                    }
                    continue;
                }
            };
            match &tree.nodes[index] {
                Node::Split { plane, front, back, .. } => {
                    let height = plane.distance(&view.eye);
                    let (near, far) = if height > 0.0 { (front, back) } else { (back, front) };
                    todo.push(Step::Tree(*far));
                    if height.abs() > PLANE_TOLERANCE_M {
                        todo.push(Step::Facets(index, height > 0.0));
                    }
                    todo.push(Step::Tree(*near));
                }
                Node::Leaf { solids } => {
                    sort_by_distance(solids, &map.prisms, &view, standing);
                    for Standing { solid, .. } in standing.iter() {
                        draw_solid(&solids[*solid], &map.prisms, &view, canvas, emit);
                    }
                }
            }
        }
        Ok(())
    }

    /// [`MapRenderer::spans`] without the pixels near an edge, whose label is sensitive to the pose.
    ///
    /// Keeps pixels whose neighbours up to `margin` pixels away, also across corners, all show the same colour. The image's own border is no edge; a
    /// pixel without map colour is one.
    /// # Errors
    /// Returns the errors of [`MapRenderer::spans`].
    pub fn inner_spans(
        &mut self,
        camera_pose: &Pose3<f64>,
        margin: u16,
        emit: &mut impl FnMut(PixelSpan),
    ) -> Result<(), RenderError> {
        if margin == 0 {
            return self.spans(camera_pose, emit);
        }
        let mut labels = match self.margin.take() {
            Some(labels) => labels,
            None => Margin::new(&self.camera, self.map.colors().len()),
        };
        labels.clear();
        let seen = self.spans(camera_pose, &mut |span| labels.add(span));
        if seen.is_ok() {
            labels.erode(usize::from(margin));
            labels.spans(emit);
        }
        self.margin = Some(labels);
        seen
    }

    /// Renders the view as an image.
    /// # Errors
    /// Returns the errors of [`MapRenderer::spans`].
    pub fn labels(&mut self, camera_pose: &Pose3<f64>) -> Result<LabelImage, RenderError> {
        let mut labels = LabelImage::empty(self.camera.width(), self.camera.height());
        self.spans(camera_pose, &mut |span| labels.paint(span))?;
        Ok(labels)
    }
}

/// The solids of a leaf that are in view, the nearest first.
fn sort_by_distance(solids: &[Solid], prisms: &[Prism], view: &View, standing: &mut Vec<Standing>) {
    standing.clear();
    for (solid, Solid { prism, .. }) in solids.iter().enumerate() {
        let prism = &prisms[*prism];
        let (center, radius) = prism.ball();
        if view.misses(&center, radius) {
            continue;
        }
        let (x, y) = (view.eye.x - prism.x, view.eye.y - prism.y);
        standing.push(Standing {
            power: x * x + y * y - prism.corner_radius * prism.corner_radius,
            gap: (prism.from - view.eye.z).max(view.eye.z - prism.to).max(0.0),
            solid,
        });
    }
    standing.sort_unstable_by(|a, b| a.power.total_cmp(&b.power).then(a.gap.total_cmp(&b.gap)));
}

fn draw_solid(
    solid: &Solid,
    prisms: &[Prism],
    view: &View,
    canvas: &mut Canvas,
    emit: &mut impl FnMut(PixelSpan),
) {
    let Some(faces) = &solid.faces else {
        return canvas.prism(&prisms[solid.prism], view, emit);
    };
    // The visible faces of a convex shape do not hide each other.
    for Face { facet, .. } in faces.iter().filter(|face| face.plane.distance(&view.eye) > PLANE_TOLERANCE_M) {
        canvas.facet(facet, true, view, emit);
    }
}
