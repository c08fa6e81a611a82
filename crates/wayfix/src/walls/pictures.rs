use wayfix_estimation_traits::Pose2;

use super::WallRun;
use crate::plot::{MapPlot, Picture, PlotError};

/// The map of walls with the path in it.
///
/// # Errors
/// When a picture cannot be drawn.
pub fn pictures(run: &WallRun) -> Result<Vec<Picture>, PlotError> {
    let point = |pose: &Pose2<f64>| (pose.x(), pose.y());
    let keyframes = run.system.keyframes();
    let walls = run.system.filter().landmarks();
    let map = MapPlot {
        title: "Path and walls".to_owned(),
        truth: run.samples().iter().map(|(_, sample)| point(&sample.truth)).collect(),
        estimate: keyframes.iter().map(|keyframe| point(&keyframe.pose)).collect(),
        dead_reckoning: keyframes.iter().map(|keyframe| point(&keyframe.dead_reckoning)).collect(),
        surroundings: walls.map(|wall| wall.mean.ends().map(|end| (end.x, end.y)).to_vec()).collect(),
        ..MapPlot::default()
    };
    Ok(vec![map.draw()?])
}
