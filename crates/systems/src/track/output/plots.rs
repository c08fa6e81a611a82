use super::super::{TargetColorDistribution, TrackRunHistory};
use super::run_history::Point;
use wayfix_evaluation::plot::{
    CovarianceEllipsesPlot, FilmStrip, FilmStripFrame, LinePlot, NamedEllipse, PlotError, PlotSeries, SvgPlot,
};

/// Film frames per row.
const FRAMES_A_ROW: usize = 3;

/// Plots frames with the target outline, the overlap with the truth over the frames, and the path of the target's colour if known.
///
/// # Errors
/// Returns an error if a picture cannot be drawn.
pub fn plots(run_history: &TrackRunHistory) -> Result<Vec<SvgPlot>, PlotError> {
    let mut plots = vec![film(run_history).draw()?, overlap(run_history).draw()?];
    if let Some(colors) = run_history.points.kept().iter().find_map(|point| point.colors) {
        let names = colors.space.axis_names();
        plots.push(clouds(run_history, names).draw()?);
        plots.push(color_path(run_history, names).draw()?);
    }
    Ok(plots)
}

fn film(run_history: &TrackRunHistory) -> FilmStrip {
    let frame = |(index, image): &(usize, _)| FilmStripFrame {
        image: wayfix_sensor_log::EncodedImage::clone(image),
        caption: format!("frame {index}"),
    };
    let frames: Vec<FilmStripFrame> = run_history.film.kept().iter().map(frame).collect();
    let legend = |row: usize| match row {
        0 => "yellow: tracked, red: lost, green: true box".to_owned(),
        _ => String::new(),
    };
    FilmStrip {
        title: "The target in the pictures".to_owned(),
        rows: frames
            .chunks(FRAMES_A_ROW)
            .enumerate()
            .map(|(row, frames)| (legend(row), frames.to_vec()))
            .collect(),
        frame_size: run_history.frame_size,
    }
}

fn overlap(run_history: &TrackRunHistory) -> LinePlot {
    let points = run_history.points.kept();
    let iou = points.iter().filter_map(|point| Some((point.index as f64, point.iou?))).collect();
    let quality = points.iter().map(|point| (point.index as f64, point.quality)).collect();
    let series =
        [PlotSeries::new("overlap with the truth", iou), PlotSeries::new("the tracker's quality", quality)];
    LinePlot {
        title: "Overlap over the frames".to_owned(),
        x_label: frames(run_history),
        y_label: "intersection over union; quality".to_owned(),
        series: series.into_iter().filter(|series| !series.points.is_empty()).collect(),
        ..LinePlot::default()
    }
}

/// The colour distribution along its path, as ellipses in two planes of the space. [Andrade-Cetto 2005, Figs. 8 and 13]
fn clouds(run_history: &TrackRunHistory, names: [&str; 3]) -> CovarianceEllipsesPlot {
    let plane = |v: usize| {
        let ellipse = |(index, colors): &(usize, TargetColorDistribution)| NamedEllipse {
            name: format!("frame {index}"),
            center: (colors.mean[0], colors.mean[v]),
            covariance: [0, v].map(|i| [0, v].map(|j| colors.covariance[(i, j)])),
        };
        (format!("{} over {}", names[v], names[0]), run_history.clouds.kept().iter().map(ellipse).collect())
    };
    CovarianceEllipsesPlot {
        title: "Path of the colour distribution (1σ)".to_owned(),
        x_label: names[0].to_owned(),
        sigmas: 1.0,
        groups: [1, 2].map(plane).to_vec(),
    }
}

/// The path of the target's mean colour.
fn color_path(run_history: &TrackRunHistory, names: [&str; 3]) -> LinePlot {
    let axis = |c: usize| {
        let point = |point: &Point| Some((point.index as f64, point.colors?.mean[c]));
        PlotSeries::new(names[c], run_history.points.kept().iter().filter_map(point).collect())
    };
    LinePlot {
        title: "Mean colour of the target".to_owned(),
        x_label: frames(run_history),
        y_label: "share of the axis".to_owned(),
        series: [0, 1, 2].map(axis).to_vec(),
        ..LinePlot::default()
    }
}

fn frames(run_history: &TrackRunHistory) -> String {
    match run_history.points.stride() {
        1 => "frame".to_owned(),
        stride => format!("frame, one in {stride}"),
    }
}
