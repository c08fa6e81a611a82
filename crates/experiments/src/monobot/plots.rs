use super::{MonobotDrive, MonobotStep, first_entry};
use wayfix_evaluation::plot::{LinePlot, PlotError, PlotSeries, SvgPlot};

/// The four columns of [Andrade-Cetto 2005, Figs. 4–6] for one drive: places, robot error, landmark error, gains.
///
/// # Errors
/// Returns an error if a picture cannot be drawn.
pub(crate) fn plots(drive: &MonobotDrive) -> Result<Vec<SvgPlot>, PlotError> {
    let line = |value: &dyn Fn(&MonobotStep) -> f64| -> Vec<(f64, f64)> {
        drive.steps.iter().enumerate().map(|(k, step)| (k as f64, value(step))).collect()
    };
    let plot = |title: &str, y_label: &str, series: Vec<PlotSeries>| LinePlot {
        title: title.to_owned(),
        x_label: "step".to_owned(),
        y_label: y_label.to_owned(),
        series,
        ..LinePlot::default()
    };
    let with_bounds = |error: &dyn Fn(&MonobotStep) -> f64, sigma: &dyn Fn(&MonobotStep) -> f64| {
        vec![
            PlotSeries::new("error", line(error)),
            PlotSeries::new("+2σ", line(&|step| 2.0 * sigma(step))),
            PlotSeries::new("−2σ", line(&|step| -2.0 * sigma(step))),
        ]
    };
    let places = vec![
        PlotSeries::new("robot", line(&|step| step.true_position)),
        PlotSeries::new("its estimate", line(&|step| step.position)),
        PlotSeries::new("landmark", line(&|_| drive.true_landmark)),
        PlotSeries::new("its estimate", line(&|step| step.landmark)),
    ];
    let robot = with_bounds(&|step| step.position - step.true_position, &|step| step.position_sigma);
    let landmark = with_bounds(&|step| step.landmark - drive.true_landmark, &|step| step.landmark_sigma);
    let gains = vec![
        PlotSeries::new("robot", line(&|step| step.gains[0])),
        PlotSeries::new("landmark", line(&|step| step.gains[1])),
    ];
    [
        plot("Places", "m", places),
        plot("Robot error", "m", robot),
        plot("Landmark error", "m", landmark),
        plot("Kalman gains", "gain", gains),
    ]
    .iter()
    .map(LinePlot::draw)
    .collect()
}

/// The first entry of the total Fisher information against steps. [Andrade-Cetto 2005, Fig. 3]
///
/// # Errors
/// Returns an error if the filter or the picture refuses.
pub(crate) fn fisher_plot(n_landmarks: &[u32], n_steps: usize) -> anyhow::Result<SvgPlot> {
    let series = |n: &u32| {
        let points =
            first_entry(*n, n_steps)?.into_iter().enumerate().map(|(k, entry)| (k as f64 + 1.0, entry));
        Ok(PlotSeries::new(format!("{n} landmarks"), points.collect()))
    };
    let plot = LinePlot {
        title: "First entry of the total Fisher information".to_owned(),
        x_label: "step".to_owned(),
        y_label: "1/m²".to_owned(),
        series: n_landmarks.iter().map(series).collect::<anyhow::Result<_>>()?,
        ..LinePlot::default()
    };
    Ok(plot.draw()?)
}
