use wayfix_evaluation::plot::{LinePlot, PlotSeries, statistics};

/// Median, 90 % and 95 % quantile of position errors, m, over the runs; `at` gives the abscissa of a point and the errors there.
pub(crate) fn error_quantiles(
    title: &str,
    x_label: &str,
    n_points: usize,
    at: impl Fn(usize) -> (f64, Vec<f64>),
) -> LinePlot {
    let quantile = |share: f64| {
        let point = |i: usize| {
            let (x, errors) = at(i);
            (x, statistics::quantile(errors, share).unwrap_or(f64::NAN))
        };
        (0..n_points).map(point).collect()
    };
    LinePlot {
        title: title.to_owned(),
        x_label: x_label.to_owned(),
        y_label: "position error, m".to_owned(),
        series: vec![
            PlotSeries::new("median", quantile(0.5)),
            PlotSeries::new("90 % of the runs are below", quantile(0.9)),
            PlotSeries::new("95 %", quantile(0.95)),
        ],
        ..LinePlot::default()
    }
}
