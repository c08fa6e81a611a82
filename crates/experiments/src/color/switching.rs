use std::sync::Arc;

use anyhow::{Context, Result};
use nalgebra::Vector3;
use wayfix_color_map::ColorMap;
use wayfix_color_model::{
    ColorMeans, Gpb2LightingTracker, ImmLightingTracker, JumpMarkovLightingTracker, LabelledPixels,
    LightingFilterBank, LightingTracker, PixelClassifier, PixelLikelihoodParams, YuvImage, YuvStandard,
};
use wayfix_kalman::JumpMarkovFilterParams;
use wayfix_sensor_log::{DecodedImage, Record, RecordData, Stamp};

use wayfix_evaluation::{
    plot::{LinePlot, PlotSeries},
    report::{Metric, ReportRun},
};
use wayfix_systems::color::{ColorRun, ColorRunSetup, ColorSystemParams, run, tally};

/// The classification rate [Schulz & Fox 2004, Fig. 6] frame by frame under switched light, of a jump Markov model and of one Gaussian, both
/// while localizing; and of every light tracker with known poses.
///
/// `switches` are the frames at which the light changes; `bank` has one filter per light, `single` one for all.
/// # Errors
/// Returns an error if no image of the log can be used, or a picture not be drawn.
pub(crate) fn switching(
    records: &[Record],
    switches: &[usize],
    map: &Arc<ColorMap>,
    bank: &LightingFilterBank,
    single: &LightingFilterBank,
    params: &ColorSystemParams,
    seed: u64,
) -> Result<ReportRun> {
    let localized = |bank: &LightingFilterBank| -> Result<Curve> {
        let run = run(records, ColorRunSetup::new(map, bank, params, seed), |_| {})?;
        Ok(rates(&run))
    };
    let curves = [("jump_markov", localized(bank)?), ("single_gaussian", localized(single)?)];
    let frames = labelled_frames(records, params.yuv_standard, map.colors().len())?;
    let jump = JumpMarkovFilterParams::default();
    let pixels = &params.localizer.pixels;
    let known: [(&str, Curve); 4] = [
        ("known_pose_jump_markov", follow(JumpMarkovLightingTracker::new(bank, jump)?, &frames, pixels)?),
        ("known_pose_imm", follow(ImmLightingTracker::new(bank)?, &frames, pixels)?),
        ("known_pose_gpb2", follow(Gpb2LightingTracker::new(bank)?, &frames, pixels)?),
        ("known_pose_single_gaussian", follow(single.member(0).clone(), &frames, pixels)?),
    ];
    let mut metrics = Vec::new();
    for (name, curve) in curves.iter().chain(&known) {
        metrics.push(Metric::new(
            format!("{name}_classification_rate"),
            mean(curve.iter().map(|point| point.1)),
            "",
        ));
        metrics.push(Metric::new(
            format!("{name}_classification_rate_worst_drop_at_switch"),
            worst_drop(curve, switches),
            "",
        ));
    }
    let figures = vec![
        plot("Classification rate while lights are switched, localizing", &curves).draw()?,
        plot("The same with known poses", &known).draw()?,
    ];
    Ok(ReportRun { metrics, figures, ..ReportRun::default() })
}

/// Frame and rate.
type Curve = Vec<(f64, f64)>;

fn rates(run: &ColorRun) -> Curve {
    let rate = |(at, frame): (usize, &wayfix_systems::color::ColorFrameResult)| {
        Some((at as f64, frame.labelled.as_ref()?.rate()?))
    };
    run.system.frames().iter().enumerate().filter_map(rate).collect()
}

/// The largest fall of the mean rate over ten frames, from before a switch to after it.
fn worst_drop(curve: &Curve, switches: &[usize]) -> f64 {
    const AROUND: f64 = 10.0;
    let between = |from: f64, to: f64| {
        mean(curve.iter().filter(|(at, _)| *at >= from && *at < to).map(|(_, rate)| *rate))
    };
    let fall = |&switch: &usize| {
        let at = switch as f64;
        between(at - AROUND, at) - between(at, at + AROUND)
    };
    let is_shown =
        |switch: &&usize| curve.last().is_some_and(|(last, _)| *last >= **switch as f64 + AROUND - 1.0);
    switches.iter().filter(is_shown).map(fall).fold(f64::NEG_INFINITY, f64::max)
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = values.fold((0.0, 0), |(sum, n), value| (sum + value, n + 1));
    sum / f64::from(n)
}

fn plot(title: &str, curves: &[(&str, Curve)]) -> LinePlot {
    LinePlot {
        title: title.to_owned(),
        x_label: "frame".to_owned(),
        y_label: "classification rate".to_owned(),
        series: curves
            .iter()
            .map(|(name, curve)| PlotSeries::new(name.replace('_', " "), curve.clone()))
            .collect(),
        ..LinePlot::default()
    }
}

/// An image with its true labels.
struct Labelled {
    stamp: Stamp,
    image: YuvImage,
    labels: DecodedImage,
    means: ColorMeans,
}

fn labelled_frames(records: &[Record], yuv: YuvStandard, n_colors: usize) -> Result<Vec<Labelled>> {
    let mut labels = None;
    let mut frames = Vec::new();
    for record in records {
        match &record.data {
            RecordData::TrueLabels(truth) => labels = Some((record.stamp, truth)),
            RecordData::Image(image) => {
                let Some((_, truth)) = labels.take().filter(|(stamp, _)| *stamp == record.stamp) else {
                    continue;
                };
                let decoded = image.decode_rgb()?;
                let image = YuvImage::from_rgb(decoded.width, decoded.height, &decoded.pixels, yuv)?;
                let labels = truth.decode_gray()?;
                let means = means(&image, &labels, n_colors);
                frames.push(Labelled { stamp: record.stamp, image, labels, means });
            }
            _ => {}
        }
    }
    frames.first().context("the log has no true labels")?;
    Ok(frames)
}

/// The mean of every colour's labelled pixels, where there are at least 30.
fn means(image: &YuvImage, labels: &DecodedImage, n_colors: usize) -> ColorMeans {
    const MIN_PIXELS: u64 = 30;
    let mut labelled = LabelledPixels::new(n_colors);
    for (pixel, label) in image.pixels().iter().zip(&labels.pixels) {
        labelled.add(*label, &Vector3::from(pixel.map(f64::from)));
    }
    labelled.means(MIN_PIXELS)
}

/// The rate of every frame after the tracker has seen it.
fn follow(
    mut tracker: impl LightingTracker,
    frames: &[Labelled],
    pixels: &PixelLikelihoodParams,
) -> Result<Curve> {
    let mut last = frames.first().map(|frame| frame.stamp);
    let mut curve = Curve::new();
    for (at, frame) in frames.iter().enumerate() {
        let seconds = last.map_or(0.0, |last| frame.stamp.seconds_since(last));
        tracker.predict(seconds)?;
        tracker.update(&frame.means)?;
        last = Some(frame.stamp);
        let classifier = PixelClassifier::new(pixels.shaded(tracker.colors()?))?;
        let counts = tally(&frame.image, &frame.labels, &classifier, frame.means.n_colors());
        curve.extend(counts.and_then(|counts| counts.rate()).map(|rate| (at as f64, rate)));
    }
    Ok(curve)
}
