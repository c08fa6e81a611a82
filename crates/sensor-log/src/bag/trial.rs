use wayfix_estimation_traits::Pose2;

use super::candidate::Candidate;
use super::motion::planar;
use super::transforms::{is_body, last_part};
use crate::image::picture;
use crate::ros::{RosMessage, RosSchema};

/// The frame of wheel odometry. [REP 105]
pub(super) const ODOMETRY_FRAME: &str = "odom";

/// A topic that is put to a trial before it is chosen.
#[derive(Debug)]
pub(crate) struct Question {
    /// Which of the file's topics.
    pub(crate) index: usize,
    pub(crate) schema: RosSchema,
    pub(crate) trial: Trial,
}

/// What has to be seen of a topic before it is known whether to read it.
#[derive(Debug)]
pub(crate) enum Trial {
    /// Whether the first image can be read.
    Image,
    /// Whether the robot ever moves by the poses.
    Poses { first: Option<Pose2<f64>> },
    /// Whether there is odometry among the transforms.
    Transforms,
}

/// What has to be found out of a file by reading.
pub(super) fn questions(
    motion: Option<Candidate<'_>>,
    images: &[Candidate<'_>],
    transforms: &[Candidate<'_>],
) -> Vec<Question> {
    let question =
        |topic: &Candidate<'_>, trial| Question { index: topic.index, schema: topic.schema, trial };
    // One camera alone is read whatever it sends: what is wrong with it gets told message by message.
    let images = if images.len() > 1 { images } else { &[] };
    let mut questions: Vec<Question> = images.iter().map(|image| question(image, Trial::Image)).collect();
    match motion {
        Some(odometry) if odometry.is_odometry() => {
            questions.push(question(&odometry, Trial::Poses { first: None }));
        }
        Some(_) => {
            // What is said to stand still is no odometry.
            let moving = transforms.iter().filter(|topic| !topic.topic.name.ends_with("tf_static"));
            questions.extend(moving.map(|topic| question(topic, Trial::Transforms)));
        }
        None => {}
    }
    questions
}

impl Trial {
    /// Looks at a message: an answer, or `None` when more have to be seen.
    pub(crate) fn look(&mut self, schema: RosSchema, bytes: &[u8]) -> Option<bool> {
        match (self, schema.decode(bytes)) {
            (Self::Image, message) => Some(match message {
                Ok(RosMessage::Image(image)) => image.pixels().uncompressed().is_ok(),
                Ok(RosMessage::CompressedImage(image)) => picture(image.format, image.data).is_ok(),
                _ => false,
            }),
            (Self::Poses { first }, Ok(RosMessage::Odometry(odometry))) => {
                let pose = planar(&odometry.pose).ok()?;
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
}
