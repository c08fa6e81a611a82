use super::ConsistencyMonteCarlo;
use wayfix_evaluation::plot::{AxisScale, LinePlot, PlotBand, PlotError, PlotSeries, SvgPlot};

/// Average NEES of all filters over time, with the band at any one scan.
/// # Errors
/// Returns an error if the picture cannot be drawn.
pub(crate) fn picture(runs: &ConsistencyMonteCarlo) -> Result<SvgPlot, PlotError> {
    let series = runs.courses.iter().map(|course| {
        let points = course.samples.iter().map(|sample| (sample.seconds, sample.nees)).collect();
        PlotSeries::new(course.kind.name().replace('_', " "), points)
    });
    let (low, high) = (runs.band.low, runs.band.high);
    let plot = LinePlot {
        title: format!("NEES of the pose, average of {} logs", runs.n_runs),
        x_label: "time, s".to_owned(),
        y_label: "NEES, 3 expected".to_owned(),
        series: series.collect(),
        y_scale: AxisScale::Log10,
        band: Some(PlotBand { name: format!("95 % band {low:.2} to {high:.2}"), low, high }),
        ..LinePlot::default()
    };
    plot.draw()
}
