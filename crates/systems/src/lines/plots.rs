use nalgebra::Vector2;

use super::{LineExtractionSystem, ScanWalls};
use wayfix_evaluation::plot::{MapPlot, PlotError, SvgPlot};

/// Number of scans drawn, spread evenly over the log.
const N_SCANS: usize = 3;

/// Plots the walls of a sample of scans with a known pose, and some scans with their walls. [Andrade-Cetto 2005, Fig. 1b]
///
/// # Errors
/// Returns an error if a picture cannot be drawn.
pub fn plots(system: &LineExtractionSystem) -> Result<Vec<SvgPlot>, PlotError> {
    let scans = system.sample();
    let mut plots = Vec::new();
    if scans.iter().any(|scan| scan.pose.is_some()) {
        plots.push(map(system).draw()?);
    }
    let n_drawn = N_SCANS.min(scans.len());
    for k in 0..n_drawn {
        plots.push(one(&scans[scans.len() * (k + 1) / (n_drawn + 1)]).draw()?);
    }
    Ok(plots)
}

fn map(system: &LineExtractionSystem) -> MapPlot {
    let placed = || system.sample().iter().filter_map(|scan| Some((scan.pose?, scan)));
    let path = placed().map(|(pose, _)| (pose.x(), pose.y())).collect();
    let walls = placed().flat_map(|(pose, scan)| {
        scan.segments.iter().map(move |s| line(pose.transform(&s.start), pose.transform(&s.end)))
    });
    let plot = MapPlot {
        title: "The walls of up to 256 scans, from the poses of the log".to_owned(),
        walls: walls.collect(),
        ..MapPlot::default()
    };
    if system.true_walls().is_empty() {
        return MapPlot { estimate: path, ..plot };
    }
    let title = format!("{}; grey: the true ones", plot.title);
    let surroundings = system.true_walls().iter().map(|wall| line(wall.start, wall.end)).collect();
    MapPlot { title, truth: path, surroundings, ..plot }
}

fn one(scan: &ScanWalls) -> MapPlot {
    let echoes = scan.echoes.iter().map(|(bearing, range)| (range * bearing.cos(), range * bearing.sin()));
    MapPlot {
        title: format!("Scan at {:.1} s: {} walls", scan.stamp.seconds(), scan.segments.len()),
        walls: scan.segments.iter().map(|segment| line(segment.start, segment.end)).collect(),
        echoes: echoes.collect(),
        ..MapPlot::default()
    }
}

fn line(start: Vector2<f64>, end: Vector2<f64>) -> Vec<(f64, f64)> {
    vec![(start.x, start.y), (end.x, end.y)]
}
