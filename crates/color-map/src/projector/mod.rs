//! What a camera sees of a map, as spans.

mod pose;

use std::sync::Arc;

use wayfix_estimation_traits::Pose3;

use crate::{Camera, ColorId, ColorMap, LabelImage, Span, ViewError};

/// Draws a map as one camera sees it.
///
/// Keeps its scratch space from view to view, so make one a thread.
pub struct Projector {
    map: Arc<ColorMap>,
    camera: Camera,
}

impl Projector {
    /// For one map and camera.
    pub fn new(map: Arc<ColorMap>, camera: Camera) -> Self {
        Self { map, camera }
    }

    /// The map.
    pub fn map(&self) -> &ColorMap {
        &self.map
    }

    /// The camera.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Emits every pixel that sees a map colour exactly once, in spans of no particular order.
    ///
    /// `camera_pose` is the camera's in the world: x forward, y left, z up.
    ///
    /// # Errors
    /// [`ViewError::Pose`] if the pose is not finite, farther than 1e6 m away, or its quaternion not of unit length. Nothing is emitted then.
    pub fn spans(&mut self, camera_pose: &Pose3<f64>, emit: &mut impl FnMut(Span)) -> Result<(), ViewError> {
        pose::check(camera_pose)?;
        let color_at = |column: u32, row: u32| {
            let ray = self.camera.ray(f64::from(column) + 0.5, f64::from(row) + 0.5);
            self.map.cast(&camera_pose.translation, &(camera_pose.rotation * ray)).map(|hit| hit.color)
        };
        for row in 0..self.camera.height() {
            let mut run: Option<(u32, ColorId)> = None;
            for column in 0..=self.camera.width() {
                let color = if column < self.camera.width() { color_at(column, row) } else { None };
                if let Some((start, run_color)) = run
                    && color != Some(run_color)
                {
                    emit(Span { row: row as u16, start: start as u16, end: column as u16, color: run_color });
                    run = None;
                }
                if run.is_none() {
                    run = color.map(|color| (column, color));
                }
            }
        }
        Ok(())
    }

    /// [`Projector::spans`] without the pixels near an edge: left are those whose neighbours up to `margin` pixels away, also across
    /// corners, all see the same colour. The image's own border is no edge.
    ///
    /// # Errors
    /// As [`Projector::spans`].
    pub fn inner_spans(
        &mut self,
        camera_pose: &Pose3<f64>,
        margin: u16,
        emit: &mut impl FnMut(Span),
    ) -> Result<(), ViewError> {
        let labels = self.labels(camera_pose)?;
        let (width, height, reach) = (labels.width(), labels.height(), u32::from(margin));
        for row in 0..height {
            for column in 0..width {
                let Some(color) = labels.get(column, row) else { continue };
                let mut rows = row.saturating_sub(reach)..(row + reach + 1).min(height);
                let columns = column.saturating_sub(reach)..(column + reach + 1).min(width);
                if rows.all(|r| columns.clone().all(|c| labels.get(c, r) == Some(color))) {
                    emit(Span { row: row as u16, start: column as u16, end: column as u16 + 1, color });
                }
            }
        }
        Ok(())
    }

    /// What the camera sees, as an image.
    ///
    /// # Errors
    /// As [`Projector::spans`].
    pub fn labels(&mut self, camera_pose: &Pose3<f64>) -> Result<LabelImage, ViewError> {
        let mut labels = LabelImage::empty(self.camera.width(), self.camera.height());
        self.spans(camera_pose, &mut |span| labels.paint(span))?;
        Ok(labels)
    }
}
