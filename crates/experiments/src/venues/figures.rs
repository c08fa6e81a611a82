use wayfix_color_model::ColorDensity;
use wayfix_evaluation::{
    errors::MeanInterval,
    plot::{CovarianceEllipsesPlot, LinePlot, NamedEllipse, PlotError, PlotSeries, SvgPlot},
    report::Metric,
};

use super::{methods::Method, score::VenueScore, venue::Venue};

const BOUND: &str = "the own-venue oracle's 0.999 and the best known 0.994 in the worst venue, rounded down";

/// Mean and worst venue of every method, and the gain of the joint prior.
pub(super) fn metrics(scores: &[VenueScore]) -> Vec<Metric> {
    let mut metrics = Vec::new();
    for (k, method) in Method::ALL.into_iter().enumerate() {
        let rates: Vec<f64> = scores.iter().map(|score| score.rates[k].balanced()).collect();
        let (mean, worst) = (mean(&rates), worst(&rates));
        let mut mean = Metric::new(format!("{}_classification_rate_mean", method.name()), mean, "");
        let mut worst = Metric::new(format!("{}_classification_rate_worst", method.name()), worst, "");
        match method {
            Method::Joint => {
                mean = mean.at_least(0.998).bound_from(BOUND);
                worst = worst.at_least(0.99).bound_from(BOUND);
            }
            Method::Oracle => {
                mean = mean
                    .at_least(0.9985)
                    .bound_from("0.999 shows that the definition of the pixels is right");
            }
            _ => {}
        }
        metrics.extend([mean, worst]);
        if matches!(method, Method::Joint | Method::Fixed) {
            let recalls: Vec<f64> = scores.iter().map(|score| score.rates[k].of_ball()).collect();
            metrics.push(Metric::new(
                format!("{}_ball_recall_mean", method.name()),
                self::mean(&recalls),
                "",
            ));
            metrics.push(Metric::new(
                format!("{}_ball_recall_worst", method.name()),
                self::worst(&recalls),
                "",
            ));
        }
    }
    let gains: Vec<f64> = scores.iter().map(|score| score.joint_gain_nats).collect();
    metrics.push(Metric::new("joint_gain_nats", mean(&gains), "nats"));
    metrics
}

/// A summary of the joint prior's gain in words.
pub(super) fn note(scores: &[VenueScore]) -> String {
    let gains: Vec<f64> = scores.iter().map(|score| score.joint_gain_nats).collect();
    let verdict = match MeanInterval::of(&gains) {
        Some(gain) if gain.mean - gain.half_width > 0.0 => "a gain",
        Some(gain) if gain.mean + gain.half_width < 0.0 => "a loss",
        _ => "no significant difference",
    };
    let interval = MeanInterval::of(&gains).map_or_else(String::new, |gain| {
        format!(" ({:.2} ± {:.2} nats a venue)", gain.mean, gain.half_width)
    });
    format!(
        "The mean ball of a venue left out, predicted with the carpet (joint prior) and without it (independent prior): {verdict}{interval}."
    )
}

/// The rate of every venue by method, and carpet and ball in UV.
pub(super) fn plots(venues: &[Venue], scores: &[VenueScore]) -> Result<Vec<SvgPlot>, PlotError> {
    let series = Method::ALL.into_iter().enumerate().map(|(k, method)| {
        let points =
            scores.iter().enumerate().map(|(venue, score)| (venue as f64 + 1.0, score.rates[k].balanced()));
        PlotSeries::new(method.title(), points.collect())
    });
    let rates = LinePlot {
        title: "Separation of ball and carpet in a venue left out".to_owned(),
        x_label: "venue, in the order of the ellipses' legend".to_owned(),
        y_label: "share of pixels".to_owned(),
        series: series.collect(),
        ..LinePlot::default()
    };
    let carpets = |venue: &Venue| venue.images.first().map(|image| image.carpet.density);
    let colors = CovarianceEllipsesPlot {
        title: "Carpets and balls in UV, 1σ, first image and all balls of each venue".to_owned(),
        x_label: "U".to_owned(),
        sigmas: 1.0,
        groups: vec![
            ("carpet, V".to_owned(), ellipses(venues, carpets)),
            ("ball, V".to_owned(), ellipses(venues, Venue::ball)),
        ],
    };
    Ok(vec![rates.draw()?, colors.draw()?])
}

fn ellipses(venues: &[Venue], density: impl Fn(&Venue) -> Option<ColorDensity>) -> Vec<NamedEllipse> {
    let ellipse = |venue: &Venue| {
        let ColorDensity { mean, covariance } = density(venue)?;
        let covariance = [[covariance.m22, covariance.m23], [covariance.m32, covariance.m33]];
        Some(NamedEllipse { name: venue.name.clone(), center: (mean.y, mean.z), covariance })
    };
    venues.iter().filter_map(ellipse).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// NaN counts as the worst.
fn worst(values: &[f64]) -> f64 {
    values
        .iter()
        .copied()
        .fold(f64::INFINITY, |worst, value| if value < worst || value.is_nan() { value } else { worst })
}
