use anyhow::Result;
use wayfix_condensation::RgbImage;
use wayfix_sensor_log::{
    EncodedImage, FoxgloveMessageWriter, ImageOutline, MessageSinks, Record, RecordData, Stamp, topics,
};
use wayfix_system_core::EstimateWriter;

use super::{
    ViewSystem, ViewTrialStep, ViewsError, ViewsRun,
    plots::{BEST, GOAL, JPEG_QUALITY, TRUTH, belief_image, slowest},
};

/// Topic of the belief, as an image of the places.
pub(super) const BELIEF: &str = "/estimate/belief";
/// Assumed duration of a move, since the log has no time.
pub(super) const NANOSECONDS_A_MOVE: u64 = 1_000_000_000;

/// Shows viewers the drive that was uncertain for longest. Each move shows the scene with the current, the most probable and the goal view,
/// and the belief over the places; without the scene unless `has_echo`.
///
/// # Errors
/// Returns an error if the drive cannot be repeated, an image cannot be encoded or a sink fails.
pub fn draw_drive(
    run: &ViewsRun,
    real: &RgbImage,
    seed: u64,
    has_echo: bool,
    sinks: MessageSinks,
) -> Result<()> {
    let encode = || EncodedImage::jpeg(real.width(), real.height(), real.as_raw(), JPEG_QUALITY);
    let scene = has_echo.then(encode).transpose()?;
    let mut drawing = EstimateDrawer { writer: FoxgloveMessageWriter::into_sink(sinks), scene };
    let mut failure = None;
    run.system.trial(seed, slowest(&run.trials), |step| {
        if failure.is_none() {
            failure = drawing.draw(&run.system, &step).err();
        }
    })?;
    match failure {
        Some(failure) => Err(failure),
        None => Ok(drawing.writer.finish()?),
    }
}

struct EstimateDrawer {
    writer: EstimateWriter,
    /// `None` where the scene is not written.
    scene: Option<EncodedImage>,
}

impl EstimateDrawer {
    fn draw(&mut self, system: &ViewSystem, step: &ViewTrialStep<'_>) -> Result<()> {
        let stamp = Stamp::from_nanoseconds(step.number as u64 * NANOSECONDS_A_MOVE);
        if let Some(scene) = &self.scene {
            self.writer.record(&Record { stamp, data: RecordData::Image(scene.clone()) })?;
        }
        let best = step.localizer.best().state;
        let marked = [(step.goal, GOAL), (best, BEST), (step.at, TRUTH)];
        let outlines: Vec<ImageOutline> =
            marked.into_iter().map(|(state, ink)| outline(system, state, ink)).collect::<Result<_, _>>()?;
        self.writer.image_outlines(topics::TARGET, stamp, &outlines)?;
        let belief = belief_image(system.views().grid(), step)?;
        Ok(self.writer.image(BELIEF, stamp, &belief)?)
    }
}

/// Outline of a state's view in the scene.
fn outline(system: &ViewSystem, state: usize, ink: [u8; 3]) -> Result<ImageOutline, ViewsError> {
    let [x, y] = <[usize; 2]>::from(system.views().corner(state)?).map(|pixel| pixel as f64);
    let [width, height] = <[usize; 2]>::from(system.views().view_size()).map(|pixels| pixels as f64);
    let points = vec![[x, y], [x + width, y], [x + width, y + height], [x, y + height]];
    let [r, g, b] = ink.map(|value| f64::from(value) / 255.0);
    Ok(ImageOutline { color: [r, g, b, 1.0], points })
}
