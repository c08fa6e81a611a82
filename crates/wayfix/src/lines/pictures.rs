use nalgebra::Vector2;

use super::{LineSystem, ScanWalls};
use crate::plot::{LinesPlot, MapPlot, Picture, PlotError, Series};

/// So many scans are drawn, evenly over the log.
const N_SCANS: usize = 3;

/// All walls where the log says that they were seen from, and some scans with their walls.
///
/// # Errors
/// When a picture cannot be drawn.
pub fn pictures(system: &LineSystem) -> Result<Vec<Picture>, PlotError> {
    let scans = system.scans();
    let mut pictures = Vec::new();
    if scans.iter().any(|scan| scan.pose.is_some()) {
        pictures.push(map(scans).draw()?);
    }
    let n_drawn = N_SCANS.min(scans.len());
    for k in 0..n_drawn {
        pictures.push(one(&scans[scans.len() * (k + 1) / (n_drawn + 1)]).draw()?);
    }
    Ok(pictures)
}

fn map(scans: &[ScanWalls]) -> MapPlot {
    let placed = || scans.iter().filter_map(|scan| Some((scan.pose?, scan)));
    let wall = |start: Vector2<f64>, end: Vector2<f64>| vec![(start.x, start.y), (end.x, end.y)];
    MapPlot {
        title: "The walls of all scans, from the poses of the log".to_owned(),
        estimate: placed().map(|(pose, _)| (pose.x(), pose.y())).collect(),
        surroundings: placed()
            .flat_map(|(pose, scan)| {
                let segments = scan.segments.iter();
                segments.map(move |s| wall(pose.transform(&s.start), pose.transform(&s.end)))
            })
            .collect(),
        ..MapPlot::default()
    }
}

fn one(scan: &ScanWalls) -> LinesPlot {
    // What is not finite leaves a gap between one wall and the next.
    let gap = (f64::NAN, f64::NAN);
    let walls = scan.segments.iter().flat_map(|s| [(s.start.x, s.start.y), (s.end.x, s.end.y), gap]);
    let echoes = scan.echoes.iter().map(|(bearing, range)| (range * bearing.cos(), range * bearing.sin()));
    LinesPlot {
        title: format!("Scan at {:.1} s: {} walls", scan.stamp.seconds(), scan.segments.len()),
        x_label: "x, m".to_owned(),
        y_label: "y, m".to_owned(),
        series: vec![Series::new("echoes in turn", echoes.collect()), Series::new("walls", walls.collect())],
        ..LinesPlot::default()
    }
}
