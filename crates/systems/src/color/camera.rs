use std::iter::Peekable;

use wayfix_color_map::{PinholeCamera, RenderError};
use wayfix_color_model::YuvImage;
use wayfix_estimation_traits::{Pose2, Pose3};
use wayfix_sensor_log::{CameraInfo, EncodedImage, Record, RecordData, Stamp};
use wayfix_system_core::RepeatedImageCheck;

use super::ColorSystemParams;

/// A camera of a log: what its records say of it.
#[derive(Default)]
pub(super) struct LoggedCamera {
    info: Option<CameraInfo>,
    mount: Option<Pose3<f64>>,
    repeated: RepeatedImageCheck,
}

/// An image with the camera that took it.
pub(super) struct PlacedImage {
    pub(super) camera: CameraInfo,
    pub(super) mount: Pose3<f64>,
    pub(super) image: YuvImage,
}

impl LoggedCamera {
    /// Takes a record of calibration or mount.
    pub(super) fn take(&mut self, data: &RecordData) {
        match data {
            RecordData::CameraInfo(info) => self.info = Some(*info),
            RecordData::CameraMount(mount) => self.mount = Some(*mount),
            _ => {}
        }
    }

    pub(super) fn move_by(&mut self, increment: &Pose2<f64>) {
        self.repeated.move_by(increment);
    }

    /// Where the camera is on the robot, once a record has said so.
    pub(super) fn mount(&self) -> Option<&Pose3<f64>> {
        self.mount.as_ref()
    }

    /// Decodes an image. Refuses one without calibration or mount, and one that repeats the last image although the robot has moved.
    pub(super) fn see(
        &mut self,
        image: &EncodedImage,
        params: &ColorSystemParams,
    ) -> Result<PlacedImage, String> {
        let camera = self.info.ok_or("no camera info before this image")?;
        let mount = self.mount.ok_or("no camera mount before this image")?;
        let decoded = image.decode_rgb().map_err(|error| error.to_string())?;
        // A covered camera, or one without light, sees the same everywhere.
        let is_blank = decoded.pixels.iter().all(|value| Some(value) == decoded.pixels.first());
        if !is_blank {
            self.repeated.check(image, camera.fx)?;
        }
        let image = YuvImage::from_rgb(decoded.width, decoded.height, &decoded.pixels, params.yuv_standard)
            .map_err(|error| error.to_string())?;
        Ok(PlacedImage { camera, mount, image })
    }
}

/// The model of a calibrated camera.
pub(super) fn pinhole(info: &CameraInfo) -> Result<PinholeCamera, RenderError> {
    PinholeCamera::new(info.width, info.height, info.fx, info.fy, info.cx, info.cy)
}

/// The records of a log, one by one.
pub type RecordIterator = Box<dyn Iterator<Item = Record> + Send>;

/// The records of a second camera, in the order of time.
pub(super) struct SecondCamera {
    records: Peekable<RecordIterator>,
    pub(super) camera: LoggedCamera,
    /// Its number in the localizer, from its first image on.
    pub(super) number: Option<usize>,
}

impl SecondCamera {
    pub(super) fn new(records: RecordIterator) -> Self {
        let is_of_camera = |record: &Record| {
            use RecordData::{CameraInfo, CameraMount, Image};
            matches!(record.data, CameraInfo(_) | CameraMount(_) | Image(_))
        };
        let records: RecordIterator = Box::new(records.filter(is_of_camera));
        Self { records: records.peekable(), camera: LoggedCamera::default(), number: None }
    }

    /// Its next image before this time; records of calibration and mount on the way are taken.
    pub(super) fn next_image_before(&mut self, stamp: Stamp) -> Option<(Stamp, EncodedImage)> {
        while let Some(record) = self.records.next_if(|record| record.stamp < stamp) {
            match record.data {
                RecordData::Image(image) => return Some((record.stamp, image)),
                other => self.camera.take(&other),
            }
        }
        None
    }
}
