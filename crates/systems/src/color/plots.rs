use std::borrow::Borrow;

use anyhow::Result;
use wayfix_color_map::{ColorId, ColorMap};
use wayfix_color_model::{LightingFilter, YuvImage};
use wayfix_evaluation::{
    errors::PoseWithTruth,
    plot::{
        FilmStrip, FilmStripFrame, LinePlot, MapPlot, NamedEllipse, PlotError, PlotSeries, PoseErrorPlot,
        PoseErrorSample, SvgPlot, named_color,
    },
};
use wayfix_sensor_log::{EncodedImage, Record, RecordData};

use super::{ColorFrameResult, ColorRun, field_lines};

/// Plots the path on the field, errors with 3σ bands, and the number of particles over time. [Schulz & Fox 2004, Fig. 3]
///
/// # Errors
/// Returns an error if a picture cannot be drawn.
pub fn plots(run: &ColorRun) -> Result<Vec<SvgPlot>, PlotError> {
    let samples = run.samples();
    let mut plots = vec![path(run, &samples).draw()?];
    if !samples.is_empty() {
        plots.push(errors(run, &samples).draw()?);
    }
    plots.push(particles(run).draw()?);
    Ok(plots)
}

/// The UV part of every colour's density. [Schulz & Fox 2004, Eq. 9, Fig. 5]
pub fn uv_ellipses(colors: &[String], light: &LightingFilter) -> Vec<NamedEllipse> {
    let ellipse = |(at, name): (usize, &String)| {
        let density = light.color(ColorId(at as u8));
        let c = density.covariance;
        NamedEllipse {
            name: name.clone(),
            center: (density.mean.y, density.mean.z),
            covariance: [[c.m22, c.m23], [c.m32, c.m33]],
        }
    };
    colors.iter().enumerate().map(ellipse).collect()
}

/// Camera frames beside their classification, spread evenly over the log of `n_images`. [Schulz & Fox 2004, Fig. 4]
///
/// # Errors
/// Returns an error if an image cannot be decoded or a picture not be drawn.
pub fn film<R: Borrow<Record>>(
    run: &mut ColorRun,
    n_images: usize,
    records: impl IntoIterator<Item = R>,
    n_frames: usize,
) -> Result<SvgPlot> {
    let n_frames = n_frames.min(n_images);
    let is_shown = |number: usize| (1..=n_frames).any(|k| n_images * k / (n_frames + 1) == number);
    let images = records.into_iter().filter_map(|record| match &record.borrow().data {
        RecordData::Image(image) => Some((run.seconds(record.borrow().stamp), image.clone())),
        _ => None,
    });
    let images: Vec<(f64, EncodedImage)> =
        images.enumerate().filter(|(number, _)| is_shown(*number)).map(|(_, image)| image).collect();
    let mut film =
        FilmStrip { title: "Camera images and their classification".to_owned(), ..FilmStrip::default() };
    let paints = paints(run.system.map());
    let (mut seen, mut classified) = (Vec::new(), Vec::new());
    // Classifies with the light at the end of the log, so early frames may look wrong.
    for (seconds, image) in images {
        let decoded = image.decode_rgb()?;
        film.frame_size = (decoded.width, decoded.height);
        let yuv = YuvImage::from_rgb(
            decoded.width,
            decoded.height,
            &decoded.pixels,
            run.system.params().yuv_standard,
        )?;
        let labels = run.system.classified(&yuv).map_err(anyhow::Error::msg)?;
        let paint = |label: &u8| paints.get(usize::from(*label)).copied().unwrap_or(BACKGROUND);
        let pixels: Vec<u8> = labels.iter().flat_map(paint).collect();
        let caption = format!("{seconds:.1} s");
        seen.push(FilmStripFrame { image: image.to_browser_format()?, caption: caption.clone() });
        let painted = EncodedImage::png_rgb(decoded.width, decoded.height, &pixels)?;
        classified.push(FilmStripFrame { image: painted, caption });
    }
    film.rows = vec![("camera".to_owned(), seen), ("classified, grey for background".to_owned(), classified)];
    Ok(film.draw()?)
}

/// Display colour of what has no class.
const BACKGROUND: [u8; 3] = [96, 96, 100];

/// The plotted colour of each colour of the map: by its name, others by their order.
fn paints(map: &ColorMap) -> Vec<[u8; 3]> {
    const OTHERS: [[u8; 3]; 4] = [[40, 140, 60], [250, 210, 40], [245, 130, 30], [50, 70, 200]];
    let paint = |(k, name): (usize, &String)| named_color(name).unwrap_or(OTHERS[k % OTHERS.len()]);
    map.colors().iter().enumerate().map(paint).collect()
}

fn path(run: &ColorRun, samples: &[(&ColorFrameResult, PoseWithTruth)]) -> MapPlot {
    let frames = run.system.frames();
    MapPlot {
        title: "Path on the field".to_owned(),
        truth: samples.iter().map(|(_, sample)| (sample.truth.x(), sample.truth.y())).collect(),
        estimate: frames.iter().map(|frame| (frame.pose.mean().x(), frame.pose.mean().y())).collect(),
        dead_reckoning: frames.iter().filter_map(|f| f.odometry.map(|pose| (pose.x(), pose.y()))).collect(),
        surroundings: field_lines(run.system.map()),
        ..MapPlot::default()
    }
}

fn errors(run: &ColorRun, samples: &[(&ColorFrameResult, PoseWithTruth)]) -> PoseErrorPlot {
    let error_sample = |(frame, sample): &(&ColorFrameResult, PoseWithTruth)| {
        let sigma = sample.covariance.diagonal().map(f64::sqrt);
        PoseErrorSample { t: run.seconds(frame.stamp), error: sample.error().into(), sigma: sigma.into() }
    };
    PoseErrorPlot {
        title: "Pose error in the robot frame".to_owned(),
        samples: samples.iter().map(error_sample).collect(),
    }
}

fn particles(run: &ColorRun) -> LinePlot {
    let series = |name: &str, value: &dyn Fn(&ColorFrameResult) -> f64| {
        let points = run.system.frames().iter().map(|frame| (run.seconds(frame.stamp), value(frame)));
        PlotSeries::new(name, points.collect())
    };
    LinePlot {
        title: "Particles".to_owned(),
        x_label: "t, s".to_owned(),
        y_label: "number".to_owned(),
        series: vec![
            series("particles", &|frame| frame.n_particles as f64),
            series("effective particles", &|frame| frame.effective_particles),
        ],
        ..LinePlot::default()
    }
}
