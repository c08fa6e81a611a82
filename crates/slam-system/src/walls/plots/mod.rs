mod search_bands;

use nalgebra::Vector2;
use wayfix_evaluation::plot::{MapPlot, PlotError, SvgPlot, wall_band};

use wayfix_slam_ekf::{LandmarkEstimate, Wall};

use super::WallRun;
use crate::slam::plots_with;

pub(super) use search_bands::SearchBandScan;

/// Path and walls with their 2σ bands and points of the scans, errors with their 3σ bands and NEES where there is truth, and step times. [Andrade-Cetto 2005, Fig. 7]
/// A scan with the search bands of the expected walls, if there are any. [Andrade-Cetto 2005, Fig. 1a]
///
/// # Errors
/// Returns an error if a picture cannot be drawn.
pub fn plots(run: &WallRun) -> Result<Vec<SvgPlot>, PlotError> {
    let point = |position: Vector2<f64>| (position.x, position.y);
    let band = |wall: &LandmarkEstimate<Wall>| {
        let covariance = wall.covariance.transpose().into();
        wall_band(wall.mean.ends().map(point), wall.mean.stretch, covariance)
    };
    let walls: Vec<_> = run.system.filter().landmarks().collect();
    let map = MapPlot {
        title: "Path, walls with their 2σ bands, and points of up to 256 scans".to_owned(),
        bands: walls.iter().map(band).collect(),
        walls: walls.iter().map(|wall| wall.mean.ends().map(point).to_vec()).collect(),
        echoes: run.system.front_end.scan_sample.points(),
        surroundings: run.true_map.iter().map(|wall| vec![point(wall.start), point(wall.end)]).collect(),
        ..MapPlot::default()
    };
    let mut plots = plots_with(run, map)?;
    let bands = run.system.front_end.search_bands.plot();
    plots.extend(bands.map(|bands| bands.draw()).transpose()?);
    Ok(plots)
}
