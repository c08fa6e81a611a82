use nalgebra::Vector2;
use wayfix_evaluation::plot::{AxisScale, ConsistencyPlot, MapPlot, PlotError, SvgPlot, wall_band};
use wayfix_gaussian_core::ChiSquaredBand;
use wayfix_line_extract::WallSegment;

use super::{LineExtractionSystem, ScanWalls, truth::squared_distances};

/// Number of scans drawn, spread evenly over the log.
const N_SCANS: usize = 3;
/// Points of a scan in the map.
const MOST_POINTS: usize = 90;
/// ρ, α.
const LINE_DIMENSION: usize = 2;
/// Walls in the running mean of the consistency picture.
const WINDOW: usize = 100;

/// Plots the walls and points of a sample of scans with a known pose, the NEES of the walls where the truth is known, and some scans with their walls.
/// [Andrade-Cetto 2005, Fig. 1b]
///
/// # Errors
/// Returns an error if a picture cannot be drawn.
pub fn plots(system: &LineExtractionSystem) -> Result<Vec<SvgPlot>, PlotError> {
    let scans = system.sample();
    let mut plots = Vec::new();
    if scans.iter().any(|scan| scan.pose.is_some()) {
        plots.push(map(system).draw()?);
    }
    plots.extend(consistency(system).map(|plot| plot.draw()).transpose()?);
    let n_drawn = N_SCANS.min(scans.len());
    for k in 0..n_drawn {
        let scan = &scans[scans.len() * (k + 1) / (n_drawn + 1)];
        plots.push(one(scan, scan.stamp.seconds_since(scans[0].stamp)).draw()?);
    }
    Ok(plots)
}

fn map(system: &LineExtractionSystem) -> MapPlot {
    let placed = || system.sample().iter().filter_map(|scan| Some((scan.pose?, scan)));
    let path = system.path().to_vec();
    let walls = placed().flat_map(|(pose, scan)| {
        scan.segments.iter().map(move |s| line(pose.transform(&s.start), pose.transform(&s.end)))
    });
    let points = placed().flat_map(|(pose, scan)| {
        let stride = scan.echoes.len().div_ceil(MOST_POINTS).max(1);
        let world = move |echo: &(f64, f64)| {
            let (x, y) = in_plane(echo);
            let point = pose.transform(&Vector2::new(x, y));
            (point.x, point.y)
        };
        scan.echoes.iter().step_by(stride).map(world)
    });
    let plot = MapPlot {
        title: "Walls and points of up to 256 scans, from the poses of the log".to_owned(),
        walls: walls.collect(),
        echoes: points.collect(),
        ..MapPlot::default()
    };
    if system.true_walls().is_empty() {
        return MapPlot { estimate: path, ..plot };
    }
    let title = format!("{}; grey: the true ones", plot.title);
    let surroundings = system.true_walls().iter().map(|wall| line(wall.start, wall.end)).collect();
    MapPlot { title, truth: path, surroundings, ..plot }
}

/// A scan, `seconds` after the first.
fn one(scan: &ScanWalls, seconds: f64) -> MapPlot {
    MapPlot {
        title: format!("Scan at {seconds:.1} s: {} walls, with their 2σ bands", scan.segments.len()),
        walls: scan.segments.iter().map(|segment| line(segment.start, segment.end)).collect(),
        bands: scan.segments.iter().map(band).collect(),
        echoes: scan.echoes.iter().map(in_plane).collect(),
        ..MapPlot::default()
    }
}

/// NEES of the walls in a sample of scans beside the true walls; `None` where nothing can be compared.
fn consistency(system: &LineExtractionSystem) -> Option<ConsistencyPlot> {
    let scans = system.sample();
    let begin = scans.first()?.stamp;
    let of_scan = |scan: &ScanWalls| {
        let t = scan.stamp.seconds_since(begin);
        squared_distances(scan, system.true_walls()).into_iter().map(move |nees| (t, nees))
    };
    let samples: Vec<(f64, f64)> = scans.iter().flat_map(of_scan).collect();
    let band = ChiSquaredBand::for_average(LINE_DIMENSION, 1, 0.95).ok().filter(|_| !samples.is_empty())?;
    Some(ConsistencyPlot {
        title: "Consistency of the walls of up to 256 scans".to_owned(),
        statistic: "NEES (ρ, α)".to_owned(),
        samples,
        expected: LINE_DIMENSION as f64,
        band: (band.low, band.high),
        window: WINDOW,
        scale: AxisScale::Log10,
    })
}

/// An echo in the frame of the sensor.
fn in_plane((bearing, range): &(f64, f64)) -> (f64, f64) {
    (range * bearing.cos(), range * bearing.sin())
}

fn band(segment: &WallSegment) -> Vec<(f64, f64)> {
    let along = segment.estimate.line.direction();
    let ends = [segment.start, segment.end];
    let covariance = segment.estimate.covariance.transpose().into();
    wall_band(ends.map(|end| (end.x, end.y)), ends.map(|end| along.dot(&end)), covariance)
}

fn line(start: Vector2<f64>, end: Vector2<f64>) -> Vec<(f64, f64)> {
    vec![(start.x, start.y), (end.x, end.y)]
}
