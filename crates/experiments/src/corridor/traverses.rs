use std::path::Path;

use anyhow::{Context, Result, ensure};
use wayfix_condensation::{DominantGrayCriterion, RgbImage, StateDescriptorTable, View};
use wayfix_sensor_log::{EncodedImage, LogOpenOptions, RecordData};

use wayfix_systems::views::{DescriptorKind, ViewsError};

/// Minimum number of frames to learn the noise from.
const MIN_FRAMES: usize = 10;

/// The frames of both traverses, in order.
pub(super) struct Traverses {
    pub(super) learned: Vec<Frame>,
    pub(super) seen: Vec<Frame>,
}

/// A picture as it is stored and as pixels.
pub(super) struct Frame {
    pub(super) image: EncodedImage,
    pub(super) picture: RgbImage,
}

impl Traverses {
    /// Reads `ref` and `query` below `folder`.
    pub(super) fn read(folder: &Path) -> Result<Self> {
        let (learned, seen) = (read(&folder.join("ref"))?, read(&folder.join("query"))?);
        if learned.len().min(seen.len()) < MIN_FRAMES {
            return Err(ViewsError::TooFewPictures {
                folder: folder.into(),
                n_learned: learned.len(),
                n_seen: seen.len(),
                min: MIN_FRAMES,
            }
            .into());
        }
        Ok(Self { learned, seen })
    }
}

/// The features of every frame.
pub(super) fn features(frames: &[Frame], kind: DescriptorKind) -> Result<StateDescriptorTable> {
    let feature = kind.feature(DominantGrayCriterion::default());
    let row = |frame: &Frame| -> Result<Vec<f64>> {
        let mut row = vec![0.0; feature.n_components()];
        feature.extract(&View::whole(&frame.picture)?, &mut row);
        Ok(row)
    };
    Ok(StateDescriptorTable::from_rows(&frames.iter().map(row).collect::<Result<Vec<_>>>()?)?)
}

fn read(folder: &Path) -> Result<Vec<Frame>> {
    let (records, report) = wayfix_sensor_log::open(folder, &LogOpenOptions::default())?.read_all();
    ensure!(report.is_clean(), "{}: {report}", folder.display());
    let images = records.into_iter().filter_map(|record| match record.data {
        RecordData::Image(image) => Some(image),
        _ => None,
    });
    let frame = |image: EncodedImage| -> Result<Frame> {
        let decoded = image.decode_rgb().with_context(|| folder.display().to_string())?;
        let picture = RgbImage::from_raw(decoded.width, decoded.height, decoded.pixels)
            .context("a decoded image has not three bytes a pixel")?;
        Ok(Frame { image, picture })
    };
    images.map(frame).collect()
}
