use wayfix_encoded_image::compressed_message;
use wayfix_estimation_traits::Pose2;

use super::candidate::Candidate;

use super::motion::planar;
use super::transforms::{is_body, last_part};
use crate::ros::{RosMessage, RosSchema};

/// The frame of wheel odometry. [REP 105]
pub(super) const ODOMETRY_FRAME: &str = "odom";

/// A topic that is probed before the selection.
#[derive(Debug)]
pub(crate) struct TopicProbe {
    /// Which of the file's topics.
    pub(crate) index: usize,
    pub(crate) schema: RosSchema,
    pub(crate) probe: Probe,
}

/// Property of a topic that decides whether it is read.
#[derive(Debug)]
pub(crate) enum Probe {
    /// Whether the first image can be read.
    Image,
    /// Whether the poses have the motion: they change, or the robot stands.
    Poses { first: Option<Pose2<f64>>, moves_by_twist: bool },
    /// Whether there is odometry among the transforms.
    Transforms,
}

/// The topics of a file that need a probe.
pub(super) fn topic_probes(
    motion: Option<Candidate<'_>>,
    images: &[Candidate<'_>],
    transforms: &[Candidate<'_>],
) -> Vec<TopicProbe> {
    let question =
        |topic: &Candidate<'_>, probe| TopicProbe { index: topic.index, schema: topic.schema, probe };
    // A single camera is read without a probe: its problems are reported message by message.
    let images = if images.len() > 1 { images } else { &[] };
    let mut topic_probes: Vec<TopicProbe> =
        images.iter().map(|image| question(image, Probe::Image)).collect();
    match motion {
        Some(odometry) if odometry.is_odometry() => {
            topic_probes.push(question(&odometry, Probe::Poses { first: None, moves_by_twist: false }));
        }
        Some(_) => {
            // Static transforms are not odometry.
            let moving = transforms.iter().filter(|topic| !topic.topic.name.ends_with("tf_static"));
            topic_probes.extend(moving.map(|topic| question(topic, Probe::Transforms)));
        }
        None => {}
    }
    topic_probes
}

impl Probe {
    /// Inspects a message: an answer, or `None` if more messages are needed.
    pub(crate) fn inspect(&mut self, schema: RosSchema, bytes: &[u8]) -> Option<bool> {
        match (self, schema.decode(bytes)) {
            (Self::Image, message) => Some(match message {
                Ok(RosMessage::Image(image)) => image.pixels().uncompressed().is_ok(),
                Ok(RosMessage::CompressedImage(image)) => {
                    compressed_message(image.format, image.data).is_ok()
                }
                _ => false,
            }),
            (Self::Poses { first, moves_by_twist }, Ok(RosMessage::Odometry(odometry))) => {
                let pose = planar(&odometry.pose).ok()?;
                let velocities = odometry.twist.linear.iter().chain(&odometry.twist.angular);
                *moves_by_twist |= velocities.into_iter().any(|velocity| *velocity != 0.0);
                (*first.get_or_insert(pose) != pose).then_some(true)
            }
            (Self::Transforms, Ok(RosMessage::Transforms(transforms))) => {
                let is_odometry = |parent, child| last_part(parent) == ODOMETRY_FRAME && is_body(child);
                let mut transforms = transforms.iter();
                transforms.any(|t| is_odometry(t.header.frame_id, t.child_frame_id)).then_some(true)
            }
            _ => None,
        }
    }

    /// The answer if all messages together gave none.
    pub(crate) fn at_end(&self) -> bool {
        matches!(self, Self::Poses { first: Some(_), moves_by_twist: false })
    }
}
