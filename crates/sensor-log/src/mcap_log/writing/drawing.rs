use foxglove::messages::{
    Color, CubePrimitive, CylinderPrimitive, ImageAnnotations, LinePrimitive, Point2, Point3,
    PointsAnnotation, Pose, SceneEntity, SceneUpdate, SpherePrimitive, TextPrimitive, Timestamp, Vector3,
    line_primitive, points_annotation,
};
use wayfix_estimation_traits::Pose2;

use super::encode;

/// Thickness of a drawn ellipse, m, and its opacity: what lies below shows.
const ELLIPSE_THICKNESS: f64 = 0.01;
const ELLIPSE_OPACITY: f64 = 0.3;
/// Width of lines and size of letters, screen pixels.
const LINE_PIXELS: f64 = 2.0;
const TEXT_PIXELS: f64 = 12.0;

/// Thickness of a drawn wall, m.
const WALL_THICKNESS: f64 = 0.05;

/// Something to draw in a viewer; a later one with the same `id` replaces it.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewerDrawing {
    /// Its identity within the topic.
    pub id: String,
    /// Red, green, blue and alpha in [0, 1].
    pub color: [f64; 4],
    /// Its shape.
    pub shape: DrawingShape,
}

/// Shapes on the ground; metres and radians.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum DrawingShape {
    /// A translucent ellipse, for instance of a covariance.
    Ellipse {
        /// Centre.
        center: [f64; 2],
        /// Half the lengths of its axes.
        semi_axes: [f64; 2],
        /// Direction of the first axis.
        angle: f64,
    },
    /// A line through points.
    Path(Vec<[f64; 2]>),
    /// An upright wall on the ground, m.
    Wall {
        /// Its ends.
        ends: [[f64; 2]; 2],
        /// Its height.
        height: f64,
    },
    /// A ball with a text beside it, for instance a landmark and its number.
    Marker {
        /// Centre.
        position: [f64; 2],
        /// Radius of the ball.
        radius: f64,
        /// The text; may be empty.
        text: String,
    },
}

/// A closed line in an image, in pixels from the upper left corner of the upper left pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageOutline {
    /// Red, green, blue and alpha in [0, 1].
    pub color: [f64; 4],
    /// Its corners, column and row.
    pub points: Vec<[f64; 2]>,
}

pub(in crate::mcap_log) fn image_annotations(
    timestamp: Timestamp,
    outlines: &[ImageOutline],
) -> ImageAnnotations {
    let annotation = |outline: &ImageOutline| {
        let [r, g, b, a] = outline.color;
        PointsAnnotation {
            timestamp: Some(timestamp),
            r#type: points_annotation::Type::LineLoop.into(),
            points: outline.points.iter().map(|[x, y]| Point2 { x: *x, y: *y }).collect(),
            outline_color: Some(Color { r, g, b, a }),
            thickness: LINE_PIXELS,
            ..Default::default()
        }
    };
    let points = outlines.iter().map(annotation).collect();
    ImageAnnotations { timestamp: Some(timestamp), points, ..Default::default() }
}

pub(in crate::mcap_log) fn scene_update(
    timestamp: Timestamp,
    frame: &str,
    drawings: &[ViewerDrawing],
) -> SceneUpdate {
    let entities = drawings.iter().map(|drawing| entity(timestamp, frame, drawing)).collect();
    SceneUpdate { entities, ..Default::default() }
}

fn entity(timestamp: Timestamp, frame: &str, drawing: &ViewerDrawing) -> SceneEntity {
    let [r, g, b, a] = drawing.color;
    let color = Color { r, g, b, a };
    let mut entity = SceneEntity {
        timestamp: Some(timestamp),
        frame_id: frame.to_owned(),
        id: drawing.id.clone(),
        ..Default::default()
    };
    match &drawing.shape {
        DrawingShape::Ellipse { center, semi_axes, angle } => {
            let ([x, y], [long, short]) = (*center, *semi_axes);
            entity.cylinders.push(CylinderPrimitive {
                pose: Some(encode::pose(&Pose2::new(x, y, *angle))),
                size: Some(Vector3 { x: 2.0 * long, y: 2.0 * short, z: ELLIPSE_THICKNESS }),
                bottom_scale: 1.0,
                top_scale: 1.0,
                color: Some(Color { a: a * ELLIPSE_OPACITY, ..color }),
            });
        }
        DrawingShape::Path(points) => entity.lines.push(path(points, color)),
        DrawingShape::Wall { ends: [[x, y], [to_x, to_y]], height } => {
            let (dx, dy) = (to_x - x, to_y - y);
            let mut pose = encode::pose(&Pose2::new(x + dx / 2.0, y + dy / 2.0, libm::atan2(dy, dx)));
            pose.position = pose.position.map(|position| Vector3 { z: height / 2.0, ..position });
            let size = Some(Vector3 { x: libm::hypot(dx, dy), y: WALL_THICKNESS, z: *height });
            entity.cubes.push(CubePrimitive { pose: Some(pose), size, color: Some(color) });
        }
        DrawingShape::Marker { position: [x, y], radius, text } => {
            let pose = Some(encode::pose(&Pose2::new(*x, *y, 0.0)));
            let size = Some(Vector3 { x: 2.0 * radius, y: 2.0 * radius, z: 2.0 * radius });
            entity.spheres.push(SpherePrimitive { pose, size, color: Some(color) });
            if !text.is_empty() {
                entity.texts.push(label(pose, text, color));
            }
        }
    }
    entity
}

fn path(points: &[[f64; 2]], color: Color) -> LinePrimitive {
    LinePrimitive {
        r#type: line_primitive::Type::LineStrip.into(),
        pose: Some(encode::identity()),
        thickness: LINE_PIXELS,
        scale_invariant: true,
        points: points.iter().map(|[x, y]| Point3 { x: *x, y: *y, z: 0.0 }).collect(),
        color: Some(color),
        ..Default::default()
    }
}

fn label(pose: Option<Pose>, text: &str, color: Color) -> TextPrimitive {
    TextPrimitive {
        pose,
        billboard: true,
        font_size: TEXT_PIXELS,
        scale_invariant: true,
        color: Some(color),
        text: text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn ellipse_is_a_flat_cylinder_along_its_first_axis() {
        let shape = DrawingShape::Ellipse { center: [1.0, -2.0], semi_axes: [3.0, 0.5], angle: 2.0 };
        let drawing = ViewerDrawing { id: "robot".to_owned(), color: [0.0, 0.5, 1.0, 1.0], shape };
        let message = scene_update(Timestamp::new(1, 5), "world", &[drawing]);
        let [cylinder] = &message.entities[0].cylinders[..] else { panic!("one cylinder") };
        let (pose, size) = (cylinder.pose.as_ref().unwrap(), cylinder.size.unwrap());
        let (position, turn) = (pose.position.unwrap(), pose.orientation.unwrap());
        assert_eq!((position.x, position.y, size.x, size.y), (1.0, -2.0, 6.0, 1.0));
        assert_abs_diff_eq!(2.0 * libm::atan2(turn.z, turn.w), 2.0, epsilon = 1e-12);
        assert_eq!((cylinder.bottom_scale, cylinder.top_scale), (1.0, 1.0));
    }

    #[test]
    fn an_outline_in_an_image_is_closed_and_keeps_its_pixels() {
        let points = vec![[0.0, 0.0], [320.0, 0.0], [160.5, 240.0]];
        let outline = ImageOutline { color: [1.0, 0.5, 0.0, 1.0], points: points.clone() };
        let message = image_annotations(Timestamp::new(1, 5), &[outline]);
        let [annotation] = &message.points[..] else { panic!("one outline") };
        assert_eq!(annotation.r#type, points_annotation::Type::LineLoop as i32);
        let corners: Vec<[f64; 2]> = annotation.points.iter().map(|point| [point.x, point.y]).collect();
        assert_eq!(corners, points);
        assert_eq!(message.timestamp, annotation.timestamp);
        assert!(
            image_annotations(Timestamp::new(1, 5), &[]).points.is_empty(),
            "nothing to draw is a message too"
        );
    }
}
