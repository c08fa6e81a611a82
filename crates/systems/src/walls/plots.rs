use nalgebra::Vector2;
use wayfix_evaluation::plot::{MapPlot, PlotError, SvgPlot};

use super::WallRun;
use crate::slam::plots_with;

/// Path and walls, errors with their 3σ bands and NEES where there is truth, and step times. [Andrade-Cetto 2005, Fig. 7]
///
/// # Errors
/// Returns an error if a picture cannot be drawn.
pub fn plots(run: &WallRun) -> Result<Vec<SvgPlot>, PlotError> {
    let point = |position: Vector2<f64>| (position.x, position.y);
    let walls = run.system.filter().landmarks();
    let map = MapPlot {
        title: "Path and walls".to_owned(),
        walls: walls.map(|wall| wall.mean.ends().map(point).to_vec()).collect(),
        surroundings: run.true_map.iter().map(|wall| vec![point(wall.start), point(wall.end)]).collect(),
        ..MapPlot::default()
    };
    plots_with(run, map)
}
