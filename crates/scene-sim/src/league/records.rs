use wayfix_sensor_log::{CameraInfo, EncodedImage, Record, RecordData, Stamp};

use super::{LeagueDrive, LeagueFrame, LeagueParams, LeaguePicture, N_COLORS};
use crate::random::RandomStreams;
use crate::{SimulationError, check};

/// Stamp of the start, nanoseconds, as in [`Simulation`](crate::Simulation).
const START_NS: u64 = 1_600_000_000_000_000_000;
/// A colour counts as in view from this many pixels on.
const IN_VIEW_PIXELS: usize = 40;

impl LeagueParams {
    /// The log of a drive, in time order: camera info at the start; before each frame but the first an odometry increment; then, at the
    /// stamp of the frame, true pose, camera mount, true labels (of some frames) and picture.
    ///
    /// The log is cut into [`n_labelled_frames`](Self::n_labelled_frames) stretches, and in each the first frame with the most map colours in view
    /// (40 pixels at least) gets labels, as a manual choice of images would.
    ///
    /// # Errors
    /// Returns [`SimulationError::Parameter`] or [`SimulationError::TooMany`] if a parameter is out of range.
    pub fn simulate(&self, streams: RandomStreams) -> Result<Vec<Record>, SimulationError> {
        check::count("labelled frames", self.n_labelled_frames, self.n_frames)?;
        let drive = LeagueDrive::new(self, streams)?;
        let camera_info = record(0, RecordData::CameraInfo(camera_info(&drive)));
        let quality = drive.venue().camera.jpeg_quality;
        let mut frames = Vec::with_capacity(self.n_frames);
        let mut labelled: Vec<Option<Labelled>> = vec![None; self.n_labelled_frames];
        for (idx, frame) in drive.enumerate() {
            if let Some(best) = labelled.get_mut(idx * self.n_labelled_frames / self.n_frames) {
                consider(idx, &frame.picture, best);
            }
            frames.push(records_of(&frame, quality)?);
        }
        for Labelled { idx, picture, .. } in labelled.into_iter().flatten() {
            let labels = EncodedImage::png_gray(picture.width, picture.height, &picture.labels)?;
            if let Some(Record { stamp, .. }) = frames[idx].last() {
                let record = Record { stamp: *stamp, data: RecordData::TrueLabels(labels) };
                let before_picture = frames[idx].len() - 1;
                frames[idx].insert(before_picture, record);
            }
        }
        Ok(std::iter::once(camera_info).chain(frames.into_iter().flatten()).collect())
    }
}

/// The best frame of a section so far.
#[derive(Clone)]
struct Labelled {
    idx: usize,
    n_colors: usize,
    picture: LeaguePicture,
}

fn consider(idx: usize, picture: &LeaguePicture, best: &mut Option<Labelled>) {
    let in_view =
        |color: u8| picture.labels.iter().filter(|&&label| label == color).count() >= IN_VIEW_PIXELS;
    let n_colors = (1..=N_COLORS as u8).filter(|&color| in_view(color)).count();
    if best.as_ref().is_none_or(|best| n_colors > best.n_colors) {
        *best = Some(Labelled { idx, n_colors, picture: picture.clone() });
    }
}

/// The picture is the last.
fn records_of(frame: &LeagueFrame, quality: u8) -> Result<Vec<Record>, SimulationError> {
    let LeaguePicture { width, height, rgb, .. } = &frame.picture;
    let jpeg = EncodedImage::jpeg(*width, *height, rgb, quality)?;
    let odometry = frame.odometry.map(|(when, moved)| record(when, RecordData::OdometryIncrement(moved)));
    let at_once =
        [RecordData::TruePose(frame.pose), RecordData::CameraMount(frame.mount), RecordData::Image(jpeg)];
    let at_once = at_once.map(|data| record(frame.milliseconds, data));
    Ok(odometry.into_iter().chain(at_once).collect())
}

fn camera_info(drive: &LeagueDrive) -> CameraInfo {
    let camera = drive.venue().camera.camera;
    CameraInfo {
        width: camera.width(),
        height: camera.height(),
        fx: camera.fx(),
        fy: camera.fy(),
        cx: camera.cx(),
        cy: camera.cy(),
    }
}

fn record(milliseconds: u64, data: RecordData) -> Record {
    Record { stamp: Stamp::from_nanoseconds(START_NS + milliseconds * 1_000_000), data }
}
