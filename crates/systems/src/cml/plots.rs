use super::{CmlRun, CmlViewResult, histogram};
use wayfix_evaluation::plot::{LinePlot, MapPlot, PlotError, PlotSeries, SvgPlot};

/// Plots the path with the references, error histogram and error over time, distance to the best reference, and number of references.
///
/// # Errors
/// Returns an error if a picture cannot be drawn.
pub fn plots(run: &CmlRun) -> Result<Vec<SvgPlot>, PlotError> {
    let samples = run.samples();
    let mut plots = vec![map(run).draw()?];
    let errors: Vec<f64> = samples.iter().map(|(_, sample)| sample.position_error()).collect();
    if !errors.is_empty() {
        let most = errors.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        plots.push(histogram("Errors of the position", most, vec![("views".to_owned(), errors)]).draw()?);
        let series = PlotSeries::new(
            "error",
            samples.iter().map(|(frame, sample)| (run.seconds(frame), sample.position_error())).collect(),
        );
        plots.push(over_time("Error over time", "position error, m", vec![series]).draw()?);
    }
    let alike = |frame: &CmlViewResult| Some((run.seconds(frame), frame.nearest?.0));
    let frames = run.system.frames();
    let distance = PlotSeries::new("nearest reference", frames.iter().filter_map(alike).collect());
    plots.push(
        over_time(
            "Descriptor distance of the most similar reference",
            "distance of the views",
            vec![distance],
        )
        .draw()?,
    );
    let count = |frame: &CmlViewResult| (run.seconds(frame), frame.n_references as f64);
    let references = PlotSeries::new("references", frames.iter().map(count).collect());
    plots.push(over_time("References in the map", "number", vec![references]).draw()?);
    Ok(plots)
}

fn map(run: &CmlRun) -> MapPlot {
    let frames = run.system.frames();
    let places = run.system.localizer().map().references().values().flat_map(|reference| &reference.places);
    MapPlot {
        title: "Path, and where the references were seen".to_owned(),
        truth: run.samples().iter().map(|(_, sample)| (sample.truth.x(), sample.truth.y())).collect(),
        estimate: frames
            .iter()
            .filter_map(|frame| frame.pose.as_ref().map(|pose| (pose.mean().x(), pose.mean().y())))
            .collect(),
        dead_reckoning: frames.iter().filter_map(|f| f.odometry.map(|pose| (pose.x(), pose.y()))).collect(),
        references: places.map(|place| (place.gaussian.mean().x(), place.gaussian.mean().y())).collect(),
        ..MapPlot::default()
    }
}

fn over_time(title: &str, y_label: &str, series: Vec<PlotSeries>) -> LinePlot {
    LinePlot {
        title: title.to_owned(),
        x_label: "t, s".to_owned(),
        y_label: y_label.to_owned(),
        series,
        ..LinePlot::default()
    }
}
