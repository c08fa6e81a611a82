use anyhow::{Result, ensure};
use wayfix_appearance_cml::{AzimuthDirection, MapLearning, OmnidirectionalRing, PanoramaDescriptorParams};
use wayfix_estimation_traits::Pose2;
use wayfix_evaluation::errors::ReferencePath;
use wayfix_sensor_log::{EncodedImage, Record, RecordData, Stamp};
use wayfix_system_core::{EventCounts, LoggedOdometry};
use wayfix_table_log::{HeadingSource, PosedFrame, PosedFrameFolder, poses};

use super::{
    CmlParams, ViewDescriptorReader, synthetic_odometry,
    turn_evidence::{AzimuthDirectionEvidence, turn_evidence},
};

/// Contents of a run: the training views, and the records to process after training.
#[derive(Clone, Debug, Default)]
pub struct CmlRunPlan {
    /// Training views with their poses.
    pub training_views: Vec<(EncodedImage, Pose2<f64>)>,
    /// In time order.
    pub records: Vec<Record>,
    /// Remarks for the user.
    pub notes: Vec<String>,
    /// Whether the true headings were measured rather than computed from the path.
    pub headings_are_measured: bool,
}

/// How to read the camera.
#[derive(Clone, Copy, Debug, Default)]
pub struct CameraViewGeometry {
    /// The ring of a raw omnidirectional image.
    pub donut: Option<OmnidirectionalRing>,
    /// Turning sense of the panorama columns; determined from the turns if not given.
    pub sense: Option<AzimuthDirection>,
}

/// σ of an unknown heading, rad.
const ANY_HEADING: f64 = 3.0;

/// Number of frames compared to find the turning sense of the columns: the first ones.
pub const N_EVIDENCE: usize = 400;

impl CmlRunPlan {
    /// Builds a plan from folders of frames. Every `withhold`-th frame is localized and the others are learned. With `learn_from`, its frames are
    /// learned and all others localized. With `withhold` 0, no frame is learned. Sets the turning sense of the columns.
    ///
    /// # Errors
    /// Returns an error if no frame can be read.
    pub fn of_recording(
        recording: &PosedFrameFolder,
        learn_from: Option<&PosedFrameFolder>,
        withhold: usize,
        params: &mut CmlParams,
        camera: &CameraViewGeometry,
        seed: u64,
    ) -> Result<Self> {
        let mut notes = Vec::new();
        let taught = learn_from.unwrap_or(recording);
        let mut heading = HeadingSource::of(&recording.frames);
        if HeadingSource::of(&taught.frames) != heading {
            heading = HeadingSource::AlongPath;
            notes.push(
                "only one of the two tables has headings: those of the paths are taken for both".to_owned(),
            );
        }
        let smoothing = params.synthetic_odometry.smoothing_frames;
        let (_, along) = poses(&taught.frames, heading, smoothing);
        let images = taught.frames.iter().map(|frame| &frame.image);
        let evidence = evidence(images.zip(along.iter().map(Pose2::heading)), params, camera);
        if let (HeadingSource::AlongPath, Some(evidence)) = (heading, evidence) {
            heading = match evidence {
                _ if evidence.is_fixed() => HeadingSource::Fixed,
                _ if evidence.is_unrelated() => HeadingSource::Unknown,
                _ => heading,
            };
        }
        if heading == HeadingSource::Unknown {
            params.taught_pose_uncertainty.heading_sigma = ANY_HEADING;
            // A map that grows during the run has no training views.
            if learn_from.is_some() || withhold > 0 {
                params.localizer.map_learning = MapLearning::Static;
            }
        }
        notes.push(describe_heading(heading).to_owned());
        notes.push(choose_sense(evidence, heading, params, camera));

        let (measured, smooth) = poses(&recording.frames, heading, smoothing);
        let increments = synthetic_odometry(&smooth, &params.synthetic_odometry.noise, seed);
        let is_taught =
            |index: usize| learn_from.is_none() && withhold > 0 && index % withhold != withhold - 1;
        let training_views = match learn_from {
            Some(other) => {
                let (poses, _) = poses(&other.frames, heading, smoothing);
                other.frames.iter().map(|frame| frame.image.clone()).zip(poses).collect()
            }
            None => {
                let chosen = (0..recording.frames.len()).filter(|index| is_taught(*index));
                chosen.map(|index| (recording.frames[index].image.clone(), measured[index])).collect()
            }
        };
        let records = records(&recording.frames, &measured, &increments, |index| !is_taught(index));
        Ok(Self { training_views, records, notes, headings_are_measured: heading == HeadingSource::Given })
    }

    /// Columns and rows of the panorama of the first usable view.
    pub fn first_size(&self, reader: &mut ViewDescriptorReader) -> Option<(usize, usize)> {
        let mut images = self.records.iter().filter_map(|record| match &record.data {
            RecordData::Image(image) => Some(image),
            _ => None,
        });
        images.find(|image| reader.describe(image).is_ok())?;
        reader.size()
    }

    /// Builds a plan from the records of a log. If it has true poses, every `withhold`-th image is localized and the others are learned; with 0 no
    /// image is learned. Sets the turning sense of the columns.
    ///
    /// # Errors
    /// Returns an error if views are to be learned and the log has no true poses.
    pub fn of_log(
        records: Vec<Record>,
        withhold: usize,
        params: &mut CmlParams,
        camera: &CameraViewGeometry,
    ) -> Result<Self> {
        let turns = image_headings(&records, params.velocity_timeout);
        let evidence = evidence(turns.iter().map(|(image, heading)| (*image, *heading)), params, camera);
        let mut plan = Self { headings_are_measured: true, ..Self::default() };
        plan.notes.push(choose_sense(evidence, HeadingSource::Given, params, camera));
        if withhold == 0 {
            plan.records = records;
            return Ok(plan);
        }
        let truth = ReferencePath::from_records(&records);
        ensure!(
            truth.last_stamp().is_some(),
            "nothing can be taught: the log has no true poses (without --withhold the map is built during the run)"
        );
        let mut n_images = 0;
        for record in records {
            if let RecordData::Image(image) = &record.data {
                n_images += 1;
                if n_images % withhold != 0 {
                    if let Some(pose) = truth.at(record.stamp) {
                        plan.training_views.push((image.clone(), pose));
                    }
                    continue;
                }
            }
            plan.records.push(record);
        }
        Ok(plan)
    }
}

fn records(
    frames: &[PosedFrame],
    poses: &[Pose2<f64>],
    increments: &[Pose2<f64>],
    is_seen: impl Fn(usize) -> bool,
) -> Vec<Record> {
    let origin = frames.first().map_or(0.0, |frame| frame.seconds);
    let mut records = Vec::new();
    for (index, (frame, pose)) in frames.iter().zip(poses).enumerate() {
        let stamp = Stamp::from_seconds(frame.seconds - origin).unwrap_or_default();
        let mut push = |data| records.push(Record { stamp, data });
        if let Some(increment) = index.checked_sub(1).and_then(|before| increments.get(before)) {
            push(RecordData::OdometryIncrement(*increment));
        }
        push(RecordData::TruePose(*pose));
        if is_seen(index) {
            push(RecordData::Image(frame.image.clone()));
        }
    }
    records
}

/// Images of a log with the odometry heading at each. Skips impossible odometry, which the system rejects and reports.
fn image_headings(records: &[Record], velocity_timeout: f64) -> Vec<(&EncodedImage, f64)> {
    let (mut odometry, mut unreported) = (LoggedOdometry::new(velocity_timeout), EventCounts::default());
    let mut heading = 0.0;
    let mut headings = Vec::new();
    for record in records {
        let motion = match &record.data {
            RecordData::Image(_) => odometry.advance_to(record.stamp, &mut unreported),
            _ => odometry.take(record, &mut unreported).unwrap_or_default(),
        };
        heading += motion.map_or(0.0, |motion| motion.increment.heading());
        if let RecordData::Image(image) = &record.data {
            headings.push((image, heading));
        }
    }
    headings
}

/// Turn evidence of the first views; skips unusable views.
fn evidence<'a>(
    images: impl Iterator<Item = (&'a EncodedImage, f64)>,
    params: &CmlParams,
    camera: &CameraViewGeometry,
) -> Option<AzimuthDirectionEvidence> {
    let views = PanoramaDescriptorParams {
        azimuth_direction: AzimuthDirection::Clockwise,
        ..params.panorama_descriptor
    };
    let mut reader = ViewDescriptorReader::new(views, camera.donut);
    let (views, headings): (Vec<_>, Vec<f64>) = images
        .take(N_EVIDENCE)
        .filter_map(|(image, heading)| Some((reader.describe(image).ok()?, heading)))
        .unzip();
    turn_evidence(&views, &headings)
}

fn choose_sense(
    evidence: Option<AzimuthDirectionEvidence>,
    heading: HeadingSource,
    params: &mut CmlParams,
    camera: &CameraViewGeometry,
) -> String {
    let told = match (camera.sense, evidence) {
        (Some(sense), _) => {
            params.panorama_descriptor.azimuth_direction = sense;
            "as told"
        }
        (None, Some(evidence)) if !matches!(heading, HeadingSource::Fixed | HeadingSource::Unknown) => {
            let counterclockwise = evidence.is_counterclockwise();
            params.panorama_descriptor.azimuth_direction = if counterclockwise {
                AzimuthDirection::Counterclockwise
            } else {
                AzimuthDirection::Clockwise
            };
            "as the turns of the robot show"
        }
        _ => "by default",
    };
    let sense = match params.panorama_descriptor.azimuth_direction {
        AzimuthDirection::Clockwise => "clockwise, left to right",
        AzimuthDirection::Counterclockwise => "counterclockwise",
    };
    format!("columns go {sense}, {told}")
}

fn describe_heading(heading: HeadingSource) -> &'static str {
    match heading {
        HeadingSource::Given => "headings are those of the table",
        HeadingSource::AlongPath => "the table has no headings: the robot is assumed to face along its path",
        HeadingSource::Unknown => {
            "the table has no headings, and the views do not turn with the path: their headings are not used, and a taught map stays as it is"
        }
        HeadingSource::Fixed => {
            "the table has no headings, and the views do not turn: the camera is assumed to keep its heading"
        }
    }
}
