use nalgebra::Vector2;

use super::WallRun;
use crate::plot::{MapPlot, Picture, PlotError};

/// The map of walls with the path in it.
///
/// # Errors
/// When a picture cannot be drawn.
pub fn pictures(run: &WallRun) -> Result<Vec<Picture>, PlotError> {
    let point = |position: Vector2<f64>| (position.x, position.y);
    let keyframes = run.system.keyframes();
    let walls = run.system.filter().landmarks();
    let map = MapPlot {
        title: "Path and walls".to_owned(),
        truth: run.samples().iter().map(|(_, sample)| point(sample.truth.translation)).collect(),
        estimate: keyframes.iter().map(|keyframe| point(keyframe.pose.translation)).collect(),
        dead_reckoning: keyframes.iter().map(|keyframe| point(keyframe.dead_reckoning.translation)).collect(),
        walls: walls.map(|wall| wall.mean.ends().map(point).to_vec()).collect(),
        surroundings: run.true_walls.iter().map(|wall| vec![point(wall.start), point(wall.end)]).collect(),
        ..MapPlot::default()
    };
    Ok(vec![map.draw()?])
}
