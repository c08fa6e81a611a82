use anyhow::Result;
use wayfix_evaluation::plot::{FilmStrip, FilmStripFrame, LinePlot, PlotSeries, SvgPlot};
use wayfix_sensor_log::{EncodedImage, FoxgloveMessageWriter, MessageSinks, Record, RecordData, Stamp};
use wayfix_table_log::MovedFrameFolder;

use super::{
    DescriptorKind, LoggedViews,
    estimates::{BELIEF, NANOSECONDS_A_MOVE},
    feature_plot,
    plots::{BEST, CELL, TRUTH, belief_map, shade},
};
use crate::system::EstimateWriter;

/// Pixels of the picture of all beliefs, at most, in each direction.
const MAX_SIDE: usize = 1200;

/// The belief over all places frame by frame, the errors where the truth is known, and the features of the places.
///
/// # Errors
/// Returns an error if a picture cannot be encoded or drawn.
pub fn logged_plots(run: &LoggedViews, feature: DescriptorKind) -> Result<Vec<SvgPlot>> {
    let mut plots = Vec::new();
    plots.extend(beliefs(run)?);
    let errors: Vec<(f64, f64)> = run.errors().map(|(frame, error)| (frame as f64, error as f64)).collect();
    if !errors.is_empty() {
        let plot = LinePlot {
            title: "How far off the best place is".to_owned(),
            x_label: "frame".to_owned(),
            y_label: "places".to_owned(),
            series: vec![PlotSeries::new(feature.title(), errors)],
            ..LinePlot::default()
        };
        plots.push(plot.draw()?);
    }
    plots.push(feature_plot(&run.learned, feature)?);
    Ok(plots)
}

/// A column a frame, a row a place, the first place at the bottom.
fn beliefs(run: &LoggedViews) -> Result<Option<SvgPlot>> {
    let beliefs: Vec<&Vec<f64>> = run.views.iter().filter_map(|view| view.belief.as_ref()).collect();
    let (n_frames, n_places) = (beliefs.len(), beliefs.first().map_or(0, |belief| belief.len()));
    if n_frames == 0 || n_frames.max(n_places) > MAX_SIDE {
        return Ok(None);
    }
    let cell = (MAX_SIDE / 2 / n_frames.max(n_places)).max(1);
    let (width, height) = (n_frames * cell, n_places * cell);
    let pixel = |i: usize| {
        let (frame, place) = (i % width / cell, n_places - 1 - i / width / cell);
        let most = beliefs[frame].iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let is_true = run.views[frame].truth == Some(place);
        // The true place is marked on every tenth frame.
        if is_true && frame % 10 == 0 { TRUTH } else { shade(beliefs[frame][place] / most) }
    };
    let pixels: Vec<u8> = (0..width * height).flat_map(pixel).collect();
    let frame_size = (width as u32, height as u32);
    let image = EncodedImage::png_rgb(frame_size.0, frame_size.1, &pixels)?;
    let legend = "frames to the right, places up; dark: believed, red: every tenth true one".to_owned();
    let caption = format!("{n_frames} frames, {n_places} places");
    let title = "Belief along the drive".to_owned();
    let rows = vec![(legend, vec![FilmStripFrame { image, caption }])];
    Ok(Some(FilmStrip { title, rows, frame_size }.draw()?))
}

/// Shows viewers the belief over the places at each frame, with the pictures of the log where `has_echo`.
///
/// # Errors
/// Returns an error if an image cannot be encoded or a sink fails.
pub fn draw_logged(
    run: &LoggedViews,
    drive: &MovedFrameFolder,
    has_echo: bool,
    sinks: MessageSinks,
) -> Result<()> {
    let mut writer: EstimateWriter = FoxgloveMessageWriter::into_sink(sinks);
    for ((number, view), frame) in (0..).zip(&run.views).zip(&drive.frames) {
        let stamp = Stamp::from_nanoseconds(number * NANOSECONDS_A_MOVE);
        if let Some(image) = frame.image.as_ref().filter(|_| has_echo) {
            writer.record(&Record { stamp, data: RecordData::Image(image.clone()) })?;
        }
        if let Some(belief) = &view.belief {
            let truth = view.truth.map(|truth| (truth, TRUTH));
            let marks: Vec<_> = std::iter::once((view.best.state, BEST)).chain(truth).collect();
            let [width, height] = [run.grid.columns(), run.grid.rows()].map(|n| (n * CELL) as u32);
            let image = EncodedImage::png_rgb(width, height, &belief_map(&run.grid, belief, &marks))?;
            writer.image(BELIEF, stamp, &image)?;
        }
    }
    Ok(writer.finish()?)
}
