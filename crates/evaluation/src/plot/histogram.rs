use super::{LinePlot, PlotSeries};

/// Shares of the steps by error, in classes of equal width, as outlines. The last class holds all larger errors.
pub fn histogram(title: &str, most_m: f64, courses: Vec<(String, Vec<f64>)>) -> LinePlot {
    const N: usize = 40;
    let width = most_m / N as f64;
    let outline = |errors: &[f64]| {
        let class = |error: &f64| ((error / width) as usize).min(N - 1);
        let mut counts = [0_usize; N];
        errors.iter().for_each(|error| counts[class(error)] += 1);
        let share = |count: usize| 100.0 * count as f64 / errors.len().max(1) as f64;
        counts
            .iter()
            .enumerate()
            .flat_map(|(k, count)| {
                [(k as f64 * width, share(*count)), ((k + 1) as f64 * width, share(*count))]
            })
            .collect()
    };
    LinePlot {
        title: title.to_owned(),
        x_label: "position error, m".to_owned(),
        y_label: "share of the steps, %".to_owned(),
        series: courses.into_iter().map(|(name, errors)| PlotSeries::new(name, outline(&errors))).collect(),
        ..LinePlot::default()
    }
}
