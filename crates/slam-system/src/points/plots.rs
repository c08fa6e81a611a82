use wayfix_evaluation::plot::{EstimatedLandmark, MapPlot, PlotError, SvgPlot};

use super::PointRun;
use crate::slam::plots_with;

/// Map and path, errors with their 3σ bands and NEES where there is truth, and step times.
///
/// # Errors
/// Returns an error if a picture cannot be drawn.
pub fn plots(run: &PointRun) -> Result<Vec<SvgPlot>, PlotError> {
    let landmarks = run.system.filter().landmarks();
    let map = MapPlot {
        title: "Path and map with 2σ ellipses".to_owned(),
        truth: run.true_positions.fixes().iter().map(|(_, fix)| (fix.x, fix.y)).collect(),
        landmarks: landmarks
            .map(|landmark| EstimatedLandmark {
                position: (landmark.mean.x, landmark.mean.y),
                covariance: landmark.covariance.transpose().into(),
            })
            .collect(),
        true_landmarks: run.true_map.values().map(|position| (position.x, position.y)).collect(),
        ..MapPlot::default()
    };
    plots_with(run, map)
}
