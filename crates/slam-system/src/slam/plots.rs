use nalgebra::DefaultAllocator;
use wayfix_evaluation::{
    errors::PoseWithTruth,
    plot::{
        AxisScale, ConsistencyPlot, MapPlot, PlotError, PoseErrorPlot, PoseErrorSample, StepTimesPlot,
        SvgPlot,
    },
};
use wayfix_gaussian_core::ChiSquaredBand;
use wayfix_slam_ekf::{LandmarkDim, MeasurementDim, RobotDim, SlamAlloc};

use super::{FrontEnd, SlamRun, StampedEstimate};

/// x, y, θ.
const POSE_DIMENSION: usize = 3;
/// Estimates in the running mean of the consistency picture.
const WINDOW: usize = 100;

/// Path and `map`, errors with their 3σ bands and NEES where there is truth, and step times.
pub(crate) fn plots_with<F: FrontEnd, T>(run: &SlamRun<F, T>, map: MapPlot) -> Result<Vec<SvgPlot>, PlotError>
where
    DefaultAllocator: SlamAlloc<RobotDim<F::Model>, LandmarkDim<F::Model>, MeasurementDim<F::Model>>,
{
    let estimates = run.system.stamped_estimates();
    let mut plots = path_plots(&run.samples(), estimates, map, !run.truth.is_estimate())?;
    plots.push(times(estimates).draw()?);
    Ok(plots)
}

/// Path and `map`, and errors with their 3σ bands and NEES where there is truth.
pub(crate) fn path_plots(
    samples: &[(StampedEstimate, PoseWithTruth)],
    estimates: &[StampedEstimate],
    map: MapPlot,
    has_nees: bool,
) -> Result<Vec<SvgPlot>, PlotError> {
    let path = MapPlot {
        truth: samples
            .iter()
            .map(|(_, sample)| (sample.truth.x(), sample.truth.y()))
            .chain(map.truth)
            .collect(),
        estimate: estimates.iter().map(|at| (at.pose.x(), at.pose.y())).collect(),
        dead_reckoning: estimates.iter().map(|at| (at.dead_reckoning.x(), at.dead_reckoning.y())).collect(),
        ..map
    };
    let mut plots = vec![path.draw()?];
    if !samples.is_empty() {
        plots.push(errors(samples).draw()?);
        let consistency = has_nees.then(|| consistency(samples)).flatten();
        plots.extend(consistency.map(|plot| plot.draw()).transpose()?);
    }
    Ok(plots)
}

fn errors(samples: &[(StampedEstimate, PoseWithTruth)]) -> PoseErrorPlot {
    let error_sample = |(stamped_estimate, sample): &(StampedEstimate, PoseWithTruth)| {
        let sigma = stamped_estimate.covariance.diagonal().map(f64::sqrt);
        PoseErrorSample {
            t: seconds(samples, stamped_estimate),
            error: sample.error().into(),
            sigma: sigma.into(),
        }
    };
    PoseErrorPlot {
        title: "Pose error in the robot frame".to_owned(),
        samples: samples.iter().map(error_sample).collect(),
    }
}

fn consistency(samples: &[(StampedEstimate, PoseWithTruth)]) -> Option<ConsistencyPlot> {
    let nees = |(stamped_estimate, sample): &(StampedEstimate, PoseWithTruth)| {
        Some((seconds(samples, stamped_estimate), sample.nees()?))
    };
    let samples: Vec<_> = samples.iter().filter_map(nees).collect();
    let band = ChiSquaredBand::for_average(POSE_DIMENSION, 1, 0.95).ok()?;
    Some(ConsistencyPlot {
        title: "Consistency of the estimate".to_owned(),
        statistic: "NEES (x, y, θ)".to_owned(),
        samples,
        expected: POSE_DIMENSION as f64,
        band: (band.low, band.high),
        window: WINDOW,
        scale: AxisScale::Log10,
    })
}

fn times(stamped_estimates: &[StampedEstimate]) -> StepTimesPlot {
    let point = |stamped_estimate: &StampedEstimate| {
        (stamped_estimate.n_landmarks as f64, stamped_estimate.step.as_secs_f64() * 1e6)
    };
    StepTimesPlot {
        title: "Computing time of a step".to_owned(),
        x_label: "landmarks in the map".to_owned(),
        points: stamped_estimates.iter().map(point).collect(),
        x_scale: AxisScale::Linear,
        y_scale: AxisScale::Log10,
    }
}

/// Time since the first sample.
fn seconds(samples: &[(StampedEstimate, PoseWithTruth)], stamped_estimate: &StampedEstimate) -> f64 {
    samples.first().map_or(0.0, |(first, _)| stamped_estimate.stamp.seconds_since(first.stamp))
}
