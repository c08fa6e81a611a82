use nalgebra::Matrix2;
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::ChiSquaredBand;

use super::{SlamRun, StampedEstimate};
use wayfix_evaluation::{
    errors::Sample,
    plot::{
        ConsistencyPlot, ErrorPlot, ErrorSample, EstimatedLandmark, MapPlot, Picture, PlotError, Scale,
        TimesPlot,
    },
};

/// x, y, θ.
const POSE_DIMENSION: usize = 3;
/// Keyframes in the running mean of the consistency picture.
const WINDOW: usize = 100;

/// Map and path, errors with their 3σ bands and NEES where there is truth, and step times.
///
/// # Errors
/// When a picture cannot be drawn.
pub fn pictures(run: &SlamRun) -> Result<Vec<Picture>, PlotError> {
    let samples = run.samples();
    let mut pictures = vec![map(run, &samples).draw()?];
    if !samples.is_empty() {
        pictures.push(errors(&samples).draw()?);
        pictures.extend(consistency(&samples).map(|plot| plot.draw()).transpose()?);
    }
    pictures.push(times(run.system.stamped_estimates()).draw()?);
    Ok(pictures)
}

fn map(run: &SlamRun, samples: &[(StampedEstimate, Sample)]) -> MapPlot {
    let point = |pose: &Pose2<f64>| (pose.x(), pose.y());
    let stamped_estimates = run.system.stamped_estimates();
    let landmark =
        |covariance: Matrix2<f64>| [[covariance.m11, covariance.m12], [covariance.m21, covariance.m22]];
    let landmarks = run.system.filter().landmarks();
    let fixes = run.true_positions.fixes().iter().map(|(_, fix)| (fix.x, fix.y));
    MapPlot {
        title: "Path and map with 2σ ellipses".to_owned(),
        truth: samples.iter().map(|(_, sample)| point(&sample.truth)).chain(fixes).collect(),
        estimate: stamped_estimates.iter().map(|stamped_estimate| point(&stamped_estimate.pose)).collect(),
        dead_reckoning: stamped_estimates
            .iter()
            .map(|stamped_estimate| point(&stamped_estimate.dead_reckoning))
            .collect(),
        landmarks: landmarks
            .map(|estimate| EstimatedLandmark {
                position: (estimate.mean.x, estimate.mean.y),
                covariance: landmark(estimate.covariance),
            })
            .collect(),
        true_landmarks: run.true_landmarks.values().map(|position| (position.x, position.y)).collect(),
        ..MapPlot::default()
    }
}

fn errors(samples: &[(StampedEstimate, Sample)]) -> ErrorPlot {
    let error_sample = |(stamped_estimate, sample): &(StampedEstimate, Sample)| {
        let sigma = stamped_estimate.covariance.diagonal().map(f64::sqrt);
        ErrorSample {
            t: seconds(samples, stamped_estimate),
            error: sample.error().into(),
            sigma: sigma.into(),
        }
    };
    ErrorPlot {
        title: "Pose error in the robot frame".to_owned(),
        samples: samples.iter().map(error_sample).collect(),
    }
}

fn consistency(samples: &[(StampedEstimate, Sample)]) -> Option<ConsistencyPlot> {
    let nees = |(stamped_estimate, sample): &(StampedEstimate, Sample)| {
        Some((seconds(samples, stamped_estimate), sample.nees()?))
    };
    let samples: Vec<_> = samples.iter().filter_map(nees).collect();
    let band = ChiSquaredBand::for_average(POSE_DIMENSION, 1, 0.95).ok()?;
    Some(ConsistencyPlot {
        title: "Is the filter as sure as it should be?".to_owned(),
        statistic: "NEES (x, y, θ)".to_owned(),
        samples,
        expected: POSE_DIMENSION as f64,
        band: (band.low, band.high),
        window: WINDOW,
        scale: Scale::Log10,
    })
}

fn times(stamped_estimates: &[StampedEstimate]) -> TimesPlot {
    let point = |stamped_estimate: &StampedEstimate| {
        (stamped_estimate.n_landmarks as f64, stamped_estimate.step.as_secs_f64() * 1e6)
    };
    TimesPlot {
        title: "Computing time of a step".to_owned(),
        x_label: "landmarks in the map".to_owned(),
        points: stamped_estimates.iter().map(point).collect(),
        x_scale: Scale::Linear,
        y_scale: Scale::Log10,
    }
}

/// Time since the first sample.
fn seconds(samples: &[(StampedEstimate, Sample)], stamped_estimate: &StampedEstimate) -> f64 {
    samples.first().map_or(0.0, |(first, _)| stamped_estimate.stamp.seconds_since(first.stamp))
}
