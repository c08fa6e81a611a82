use nalgebra::Vector2;

use super::WallRun;
use wayfix_evaluation::plot::{MapPlot, Picture, PlotError};

/// The map of walls with the path in it.
///
/// # Errors
/// When a picture cannot be drawn.
pub fn pictures(run: &WallRun) -> Result<Vec<Picture>, PlotError> {
    let point = |position: Vector2<f64>| (position.x, position.y);
    let stamped_estimates = run.system.stamped_estimates();
    let walls = run.system.filter().landmarks();
    let map = MapPlot {
        title: "Path and walls".to_owned(),
        truth: run.samples().iter().map(|(_, sample)| point(sample.truth.translation)).collect(),
        estimate: stamped_estimates
            .iter()
            .map(|stamped_estimate| point(stamped_estimate.pose.translation))
            .collect(),
        dead_reckoning: stamped_estimates
            .iter()
            .map(|stamped_estimate| point(stamped_estimate.dead_reckoning.translation))
            .collect(),
        walls: walls.map(|wall| wall.mean.ends().map(point).to_vec()).collect(),
        surroundings: run.true_walls.iter().map(|wall| vec![point(wall.start), point(wall.end)]).collect(),
        ..MapPlot::default()
    };
    Ok(vec![map.draw()?])
}
