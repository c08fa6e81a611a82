use nalgebra::Matrix2;
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::ChiSquaredBand;

use super::{Keyframe, SlamRun};
use crate::{
    evaluate::Sample,
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
    pictures.push(times(run.system.keyframes()).draw()?);
    Ok(pictures)
}

fn map(run: &SlamRun, samples: &[(Keyframe, Sample)]) -> MapPlot {
    let point = |pose: &Pose2<f64>| (pose.x(), pose.y());
    let keyframes = run.system.keyframes();
    let landmark =
        |covariance: Matrix2<f64>| [[covariance.m11, covariance.m12], [covariance.m21, covariance.m22]];
    let landmarks = run.system.filter().landmarks();
    let fixes = run.true_positions.fixes().iter().map(|(_, fix)| (fix.x, fix.y));
    MapPlot {
        title: "Path and map with 2σ ellipses".to_owned(),
        truth: samples.iter().map(|(_, sample)| point(&sample.truth)).chain(fixes).collect(),
        estimate: keyframes.iter().map(|keyframe| point(&keyframe.pose)).collect(),
        dead_reckoning: keyframes.iter().map(|keyframe| point(&keyframe.dead_reckoning)).collect(),
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

fn errors(samples: &[(Keyframe, Sample)]) -> ErrorPlot {
    let error_sample = |(keyframe, sample): &(Keyframe, Sample)| {
        let sigma = keyframe.covariance.diagonal().map(f64::sqrt);
        ErrorSample { t: seconds(samples, keyframe), error: sample.error().into(), sigma: sigma.into() }
    };
    ErrorPlot {
        title: "Pose error in the robot frame".to_owned(),
        samples: samples.iter().map(error_sample).collect(),
    }
}

fn consistency(samples: &[(Keyframe, Sample)]) -> Option<ConsistencyPlot> {
    let nees = |(keyframe, sample): &(Keyframe, Sample)| Some((seconds(samples, keyframe), sample.nees()?));
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

fn times(keyframes: &[Keyframe]) -> TimesPlot {
    let point = |keyframe: &Keyframe| (keyframe.n_landmarks as f64, keyframe.step.as_secs_f64() * 1e6);
    TimesPlot {
        title: "Computing time of a step".to_owned(),
        x_label: "landmarks in the map".to_owned(),
        points: keyframes.iter().map(point).collect(),
        x_scale: Scale::Linear,
        y_scale: Scale::Log10,
    }
}

/// Time since the first sample.
fn seconds(samples: &[(Keyframe, Sample)], keyframe: &Keyframe) -> f64 {
    samples.first().map_or(0.0, |(first, _)| keyframe.stamp.seconds_since(first.stamp))
}
