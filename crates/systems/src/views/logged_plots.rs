use anyhow::Result;
use wayfix_condensation::{DiscreteStateSpace, PositionGrid};
use wayfix_evaluation::plot::{FilmStrip, FilmStripFrame, LinePlot, PlotSeries, SvgPlot};
use wayfix_sensor_log::{EncodedImage, FoxgloveMessageWriter, MessageSinks, Record, RecordData, Stamp};
use wayfix_system_core::EstimateWriter;

use super::{
    DescriptorKind, LoggedView, LoggedViews,
    estimates::{BELIEF, NANOSECONDS_A_MOVE},
    feature_plot,
    logged::MAX_SIDE,
    plots::{BEST, CELL, TRUTH, belief_map, shade},
};

/// Beliefs over more places are drawn up to this product of frames and places.
const MAX_SHOWN: usize = 4_000_000;

/// The belief over all places frame by frame, the errors where the truth is known, and the features of the places.
///
/// # Errors
/// Returns an error if a picture cannot be encoded or drawn.
pub fn logged_plots(run: &LoggedViews, feature: DescriptorKind) -> Result<Vec<SvgPlot>> {
    let mut plots = Vec::new();
    plots.extend(beliefs(run)?);
    let errors: Vec<(f64, f64)> =
        run.errors.kept().iter().map(|(frame, error)| (*frame as f64, *error as f64)).collect();
    if !errors.is_empty() {
        let plot = LinePlot {
            title: "Error of the most probable place".to_owned(),
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
    let views = run.beliefs.kept();
    let (n_frames, n_places) = (views.len(), run.grid.n_states());
    if n_frames == 0 {
        return Ok(None);
    }
    let cell = (MAX_SIDE / 2 / n_frames.max(n_places)).max(1);
    let (width, height) = (n_frames * cell, n_places * cell);
    let pixel = |i: usize| {
        let (frame, place) = (i % width / cell, n_places - 1 - i / width / cell);
        let LoggedView { truth, belief, .. } = &views[frame];
        let most = belief.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let is_true = *truth == Some(place);
        // The true place is marked on every tenth frame.
        if is_true && frame % 10 == 0 { TRUTH } else { shade(belief[place] / most) }
    };
    let pixels: Vec<u8> = (0..width * height).flat_map(pixel).collect();
    let frame_size = (width as u32, height as u32);
    let image = EncodedImage::png_rgb(frame_size.0, frame_size.1, &pixels)?;
    let legend = "frames to the right, places up; dark: probable, red: every tenth true one".to_owned();
    let caption = format!("{n_frames} frames, {n_places} places");
    let title = "Belief along the drive".to_owned();
    let rows = vec![(legend, vec![FilmStripFrame { image, caption }])];
    Ok(Some(FilmStrip { title, rows, frame_size }.draw()?))
}

/// Shows viewers the belief over the places at each frame, with the pictures of the log where `has_echo`.
pub struct LoggedDrawing {
    writer: EstimateWriter,
    n_frames: usize,
    has_echo: bool,
}

impl LoggedDrawing {
    /// Writes into all of `sinks`, for a drive of `n_frames`.
    pub fn new(n_frames: usize, has_echo: bool, sinks: MessageSinks) -> Self {
        Self { writer: FoxgloveMessageWriter::into_sink(sinks), n_frames, has_echo }
    }

    /// Draws the belief after a frame and its picture.
    ///
    /// # Errors
    /// Returns an error if an image cannot be encoded or a sink fails.
    pub fn draw(
        &mut self,
        grid: &PositionGrid,
        view: &LoggedView,
        picture: Option<&EncodedImage>,
    ) -> Result<()> {
        let stamp = Stamp::from_nanoseconds(view.number as u64 * NANOSECONDS_A_MOVE);
        if let Some(image) = picture.filter(|_| self.has_echo) {
            self.writer.record(&Record { stamp, data: RecordData::Image(image.clone()) })?;
        }
        let n_places = grid.n_states();
        if n_places <= MAX_SIDE || self.n_frames.saturating_mul(n_places) <= MAX_SHOWN {
            let truth = view.truth.map(|truth| (truth, TRUTH));
            let marks: Vec<_> = std::iter::once((view.best.state, BEST)).chain(truth).collect();
            let [width, height] = [grid.columns(), grid.rows()].map(|n| (n * CELL) as u32);
            let image = EncodedImage::png_rgb(width, height, &belief_map(grid, &view.belief, &marks))?;
            self.writer.image(BELIEF, stamp, &image)?;
        }
        Ok(())
    }

    /// Finishes writing.
    ///
    /// # Errors
    /// Returns an error if a sink fails.
    pub fn finish(self) -> Result<()> {
        Ok(self.writer.finish()?)
    }
}
