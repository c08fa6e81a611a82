//! Cameras and their images as Foxglove messages, and back.

use foxglove::bytes::Bytes;
use foxglove::messages::{self, CameraCalibration, CompressedImage, FrameTransform, RawImage, Timestamp};
use wayfix_encoded_image::{Anymap, RawPixels, compressed_message};
use wayfix_estimation_traits::Pose3;

use super::reading::decode::{decode, stamp};
use super::topics;
use crate::fault::{Fault, finite, inconsistent, spatial, unreadable_image};
use crate::formats::format::shortened;
use crate::{CameraInfo, EncodedImage, ImageFileFormat, LogError, Record, RecordData, Stamp};

/// Rejects records that a reader could not restore.
pub(super) fn check(record: &Record) -> Result<(), LogError> {
    let stamp = record.stamp;
    match &record.data {
        RecordData::CameraInfo(info) if !info.sees() => {
            let CameraInfo { width, height, fx, fy, .. } = *info;
            Err(LogError::BadCamera { width, height, fx, fy, stamp })
        }
        RecordData::Image(image) if !is_image(image) => Err(no_image(record, image)),
        // Labels must be compressed; an uncompressed image has another message type.
        RecordData::TrueLabels(image) if !is_image(image) || image.format == ImageFileFormat::Pnm => {
            Err(no_image(record, image))
        }
        _ => Ok(()),
    }
}

fn is_image(image: &EncodedImage) -> bool {
    let has_pixels = |anymap: Anymap<'_>| anymap.width > 0 && anymap.height > 0 && anymap.is_complete();
    let is_complete = || Anymap::of(&image.bytes).is_some_and(has_pixels);
    ImageFileFormat::of_bytes(&image.bytes) == Some(image.format)
        && (image.format != ImageFileFormat::Pnm || is_complete())
}

fn no_image(record: &Record, image: &EncodedImage) -> LogError {
    let (what, n_bytes) = (record.data.kind(), image.bytes.len());
    LogError::NotAnImage { what, format: image.format, n_bytes, stamp: record.stamp }
}

pub(super) fn encode_info(timestamp: Timestamp, info: &CameraInfo) -> CameraCalibration {
    let CameraInfo { width, height, fx, fy, cx, cy } = *info;
    CameraCalibration {
        timestamp: Some(timestamp),
        frame_id: topics::CAMERA_OPTICAL_FRAME.to_owned(),
        width,
        height,
        k: vec![fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0],
        r: vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        p: vec![fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
        ..CameraCalibration::default()
    }
}

pub(super) fn encode_mount(timestamp: Timestamp, pose: &Pose3<f64>) -> FrameTransform {
    let (t, q) = (pose.translation, pose.rotation);
    FrameTransform {
        timestamp: Some(timestamp),
        parent_frame_id: topics::BODY_FRAME.to_owned(),
        child_frame_id: topics::CAMERA_FRAME.to_owned(),
        translation: Some(messages::Vector3 { x: t.x, y: t.y, z: t.z }),
        rotation: Some(messages::Quaternion { x: q.i, y: q.j, z: q.k, w: q.w }),
    }
}

/// The same camera with z forward, x right, y down.
pub(super) fn encode_optical(timestamp: Timestamp) -> FrameTransform {
    FrameTransform {
        timestamp: Some(timestamp),
        parent_frame_id: topics::CAMERA_FRAME.to_owned(),
        child_frame_id: topics::CAMERA_OPTICAL_FRAME.to_owned(),
        translation: Some(messages::Vector3::default()),
        rotation: Some(messages::Quaternion { x: -0.5, y: 0.5, z: -0.5, w: 0.5 }),
    }
}

pub(super) fn encode_image(timestamp: Timestamp, image: &EncodedImage) -> CompressedImage {
    CompressedImage {
        timestamp: Some(timestamp),
        frame_id: topics::CAMERA_OPTICAL_FRAME.to_owned(),
        data: Bytes::copy_from_slice(&image.bytes),
        format: image.format.name().to_owned(),
    }
}

/// A message with raw pixels; empty for an invalid image, which [`check`] rejects before.
pub(super) fn encode_raw_image(timestamp: Timestamp, image: &EncodedImage) -> RawImage {
    let mut message = RawImage {
        timestamp: Some(timestamp),
        frame_id: topics::CAMERA_OPTICAL_FRAME.to_owned(),
        ..RawImage::default()
    };
    if let Some(Anymap { width, height, channels, pixels }) = Anymap::of(&image.bytes) {
        message.width = width;
        message.height = height;
        message.encoding = if channels == 1 { "mono8" } else { "rgb8" }.to_owned();
        message.step = width.saturating_mul(channels);
        message.data = Bytes::copy_from_slice(pixels);
    }
    message
}

pub(super) fn info(bytes: &[u8], log_time: Stamp) -> Result<Vec<Record>, Fault> {
    let message: CameraCalibration = decode(bytes)?;
    let stamp = stamp(message.timestamp, log_time)?;
    let &[fx, skew, cx, _, fy, cy, _, _, _] = message.k.as_slice() else {
        return Err(inconsistent(&format!("camera matrix K of {} numbers, not 9", message.k.len())));
    };
    finite([fx, fy, cx, cy])?;
    let info = CameraInfo { width: message.width, height: message.height, fx, fy, cx, cy };
    if !info.sees() {
        let CameraInfo { width, height, .. } = info;
        return Err(inconsistent(&format!("{width} x {height} pixels, focal lengths {fx} and {fy}")));
    }
    // Points would be projected to wrong pixels.
    if skew != 0.0 || message.d.iter().any(|coefficient| *coefficient != 0.0) {
        let (model, d) = (shortened(&message.distortion_model), &message.d[..message.d.len().min(8)]);
        let reason =
            format!("not a pinhole camera: skew {skew}, distortion {model:?} {d:?}; rectify the images");
        return Err(inconsistent(&reason));
    }
    Ok(vec![Record { stamp, data: RecordData::CameraInfo(info) }])
}

pub(super) fn mount(bytes: &[u8], log_time: Stamp) -> Result<Vec<Record>, Fault> {
    let message: FrameTransform = decode(bytes)?;
    let stamp = stamp(message.timestamp, log_time)?;
    let (t, q) = (message.translation.unwrap_or_default(), message.rotation.unwrap_or_default());
    let pose = spatial([t.x, t.y, t.z], [q.x, q.y, q.z, q.w])?;
    Ok(vec![Record { stamp, data: RecordData::CameraMount(pose) }])
}

pub(super) fn raw_image(bytes: &[u8], log_time: Stamp) -> Result<Vec<Record>, Fault> {
    let message: RawImage = decode(bytes)?;
    let stamp = stamp(message.timestamp, log_time)?;
    let RawImage { width, height, step, encoding, data, .. } = &message;
    let pixels = RawPixels { width: *width, height: *height, encoding, step: *step, data };
    let image = pixels.uncompressed().map_err(|error| unreadable_image(&error))?;
    Ok(vec![Record { stamp, data: RecordData::Image(image) }])
}

pub(super) fn image(
    bytes: &[u8],
    log_time: Stamp,
    to_data: impl Fn(EncodedImage) -> RecordData,
) -> Result<Vec<Record>, Fault> {
    let message: CompressedImage = decode(bytes)?;
    let stamp = stamp(message.timestamp, log_time)?;
    let image =
        compressed_message(&message.format, &message.data).map_err(|error| unreadable_image(&error))?;
    Ok(vec![Record { stamp, data: to_data(image) }])
}
