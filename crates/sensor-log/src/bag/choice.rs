use std::collections::BTreeMap;
use std::path::Path;

use super::camera::{info_topic, is_rectified};
use super::candidate::{Candidate, best};
use super::kind::{BagRoute, Kind};
use super::probe::{TopicProbe, topic_probes};
use super::{BagTopic, TopicInfo, TopicUse};
use crate::LogError;

/// The topics of a bag to read, and their kinds.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Choice {
    /// By name and schema.
    routes: BTreeMap<(String, String), BagRoute>,
    /// Whether motion comes from the velocity of odometry, because its pose does not change.
    pub(super) moves_by_twist: bool,
    /// Whether motion comes from transforms, because no other topic has it.
    pub(super) moves_by_transforms: bool,
    /// Whether estimates come from transforms, because no other topic has them.
    pub(super) estimates_by_transforms: bool,
    /// Whether the selected images are rectified.
    pub(super) is_rectified: bool,
}

/// Errors of a requested choice of topics.
#[derive(Debug, PartialEq)]
pub(crate) enum ChoiceError {
    /// The topic does not exist, or holds nothing that is read.
    NotReadable { topic: String },
    /// Two of one kind.
    Ambiguous { what: &'static str, first: String, second: String },
}

impl Choice {
    /// Chooses among the topics of a file: the requested ones, and for each other kind the topic with the most messages.
    ///
    /// `passed` probes topics and returns the indices of those that passed.
    pub(crate) fn among(
        topics: &[TopicInfo],
        wanted: &[String],
        passed: impl FnOnce(Vec<TopicProbe>) -> Vec<usize>,
    ) -> Result<Self, ChoiceError> {
        let candidates: Vec<Candidate<'_>> = topics.iter().enumerate().filter_map(Candidate::of).collect();
        let wanted = wanted_of(&candidates, wanted)?;
        let of = |kind: Kind| -> Vec<Candidate<'_>> {
            let is_open =
                |topic: &Candidate<'_>| wanted.get(&kind).is_none_or(|wanted| *wanted == topic.index);
            candidates.iter().copied().filter(|topic| topic.kind == kind && is_open(topic)).collect()
        };
        let (motion, images, transforms) = (best(of(Kind::Motion)), of(Kind::Image), of(Kind::Transforms));
        let is_given = wanted.contains_key(&Kind::Motion);
        let topic_probes = topic_probes(motion, &images, if is_given { &[] } else { &transforms });
        let passed = if topic_probes.is_empty() { Vec::new() } else { passed(topic_probes) };
        let has_passed = |topic: &Candidate<'_>| passed.contains(&topic.index);

        let n_cameras = images.len();
        let image = best(images.into_iter().filter(|image| n_cameras == 1 || has_passed(image)));
        let motion = motion.filter(|motion| motion.is_odometry() || !transforms.iter().any(has_passed));
        let estimate = best(of(Kind::EstimatedPose));
        let n_all_cameras = candidates.iter().filter(|topic| topic.kind == Kind::Image).count();
        let any_camera = n_all_cameras <= 1 || wanted.contains_key(&Kind::CameraInfo);
        let chosen = [
            best(of(Kind::Scan)),
            motion,
            image,
            camera_info(image, of(Kind::CameraInfo), any_camera),
            best(of(Kind::TruePose)),
            estimate,
            best(of(Kind::MeasuredPosition)),
            best(of(Kind::MeasuredHeading)),
            best(of(Kind::MeasuredPose)),
        ];
        let chosen = chosen.into_iter().flatten().chain(transforms);
        Ok(Self {
            routes: chosen.map(|topic| (topic.key(), (topic.schema, topic.kind))).collect(),
            moves_by_twist: motion.is_some_and(|motion| motion.is_odometry() && !has_passed(&motion)),
            moves_by_transforms: motion.is_none(),
            estimates_by_transforms: estimate.is_none(),
            is_rectified: image.is_some_and(|image| is_rectified(&image.topic.name)),
        })
    }

    /// Kind that messages on this topic are read as.
    pub(crate) fn route(&self, topic: &str, schema: &str) -> Option<BagRoute> {
        self.routes.get(&(topic.to_owned(), schema.to_owned())).copied()
    }

    /// Use of every topic of ROS 2 messages, for people.
    pub(crate) fn uses(&self, topics: &[TopicInfo]) -> Vec<BagTopic> {
        let describe = |(index, topic): (usize, &TopicInfo)| {
            let r#use = match Candidate::of((index, topic)) {
                None if topic.n_messages == 0 => TopicUse::Empty,
                None => TopicUse::NotUnderstood,
                Some(Candidate { kind, .. }) if self.route(&topic.name, &topic.schema).is_some() => {
                    TopicUse::Read(kind.name())
                }
                Some(Candidate { kind, .. }) => TopicUse::NotChosen(kind.name()),
            };
            let TopicInfo { name, schema, n_messages, .. } = topic.clone();
            BagTopic { name, schema, n_messages, r#use }
        };
        topics.iter().enumerate().filter(|(_, topic)| topic.is_cdr()).map(describe).collect()
    }
}

impl ChoiceError {
    /// The error of opening a file of these topics.
    pub(crate) fn of(self, path: &Path, topics: &[TopicInfo]) -> LogError {
        let path = path.into();
        match self {
            Self::NotReadable { topic } => {
                let name = |topic: &TopicInfo| format!("{} ({})", topic.name, topic.schema);
                LogError::NoSuchTopic { path, topic, present: topics.iter().map(name).collect() }
            }
            Self::Ambiguous { what, first, second } => {
                LogError::AmbiguousTopics { path, what, first, second }
            }
        }
    }
}

/// The calibration beside the images; one at another topic only if there is one camera, or if it was requested.
fn camera_info<'a>(
    image: Option<Candidate<'a>>,
    infos: Vec<Candidate<'a>>,
    any_camera: bool,
) -> Option<Candidate<'a>> {
    let beside = image.map(|image| info_topic(&image.topic.name));
    let beside = infos.iter().find(|info| beside.as_deref() == Some(&info.topic.name)).copied();
    beside.or_else(|| best(infos).filter(|_| any_camera))
}

/// The requested topic of each kind; transforms are read from all topics.
fn wanted_of(candidates: &[Candidate<'_>], wanted: &[String]) -> Result<BTreeMap<Kind, usize>, ChoiceError> {
    let mut by_kind: BTreeMap<Kind, &Candidate<'_>> = BTreeMap::new();
    for name in wanted {
        let mut named = candidates.iter().filter(|topic| topic.topic.name == *name).peekable();
        if named.peek().is_none() {
            return Err(ChoiceError::NotReadable { topic: name.clone() });
        }
        for topic in named.filter(|topic| topic.kind != Kind::Transforms) {
            if let Some(first) = by_kind.insert(topic.kind, topic)
                && first.index != topic.index
            {
                let [first, second] = [first, topic].map(|topic| topic.topic.name.clone());
                return Err(ChoiceError::Ambiguous { what: topic.kind.name(), first, second });
            }
        }
    }
    Ok(by_kind.into_iter().map(|(kind, topic)| (kind, topic.index)).collect())
}

#[cfg(test)]
mod tests {
    use super::super::probe::Probe;
    use super::*;

    fn topic(name: &str, schema: &str, n_messages: u64) -> TopicInfo {
        TopicInfo { name: name.into(), schema: schema.into(), encoding: "cdr".into(), n_messages }
    }

    /// Names of the topics that are read.
    fn read(choice: &Choice) -> Vec<&str> {
        choice.routes.keys().map(|(name, _)| name.as_str()).collect()
    }

    fn choose(topics: &[TopicInfo], wanted: &[&str], passed: &[usize]) -> Result<Choice, ChoiceError> {
        let wanted: Vec<String> = wanted.iter().map(|&name| name.to_owned()).collect();
        Choice::among(topics, &wanted, |_| passed.to_vec())
    }

    #[test]
    fn laser_with_most_scans_is_read_and_ties_take_the_first() {
        let laser = |name, n_messages| topic(name, "sensor_msgs/msg/LaserScan", n_messages);
        let topics = [laser("/rear", 9), laser("/front", 10), laser("/top", 10)];
        let choice = choose(&topics, &[], &[]).unwrap();
        assert_eq!(read(&choice), ["/front"]);
        let uses: Vec<TopicUse> = choice.uses(&topics).into_iter().map(|topic| topic.r#use).collect();
        let other = TopicUse::NotChosen("laser scan");
        assert_eq!(uses, [other.clone(), TopicUse::Read("laser scan"), other]);
        assert_eq!(read(&choose(&topics, &["/rear"], &[]).unwrap()), ["/rear"]);
    }

    #[test]
    fn a_topic_that_is_not_there_and_two_of_a_kind_are_refused() {
        let laser = |name| topic(name, "sensor_msgs/LaserScan", 1);
        let topics = [laser("/front"), laser("/rear"), topic("/chatter", "std_msgs/msg/String", 3)];
        for name in ["/chatter", "/side"] {
            let error = choose(&topics, &[name], &[]).unwrap_err();
            assert_eq!(error, ChoiceError::NotReadable { topic: name.into() });
        }
        let error = choose(&topics, &["/front", "/rear"], &[]).unwrap_err();
        let (first, second) = ("/front".to_owned(), "/rear".to_owned());
        assert_eq!(error, ChoiceError::Ambiguous { what: "laser scan", first, second });
    }

    #[test]
    fn odometry_comes_before_transforms_and_these_before_commands() {
        let odometry = topic("/odom", "nav_msgs/msg/Odometry", 5);
        let transforms = topic("/tf", "tf2_msgs/msg/TFMessage", 50);
        let command = topic("/cmd_vel", "geometry_msgs/msg/Twist", 500);
        let all = [odometry, transforms.clone(), command.clone()];
        let choice = choose(&all, &[], &[0]).unwrap();
        assert_eq!(read(&choice), ["/odom", "/tf"]);
        assert!(!choice.moves_by_twist && !choice.moves_by_transforms);
        assert!(choose(&all, &[], &[]).unwrap().moves_by_twist, "its pose stands still");
        assert_eq!(read(&choose(&all, &["/cmd_vel"], &[]).unwrap()), ["/cmd_vel", "/tf"]);

        let without = [transforms, command];
        let choice = choose(&without, &[], &[0]).unwrap();
        assert_eq!((read(&choice), choice.moves_by_transforms), (vec!["/tf"], true));
        let choice = choose(&without, &[], &[]).unwrap();
        assert_eq!((read(&choice), choice.moves_by_transforms), (vec!["/cmd_vel", "/tf"], false));
    }

    #[test]
    fn camera_uses_its_own_calibration_and_depth_is_skipped() {
        let image = |name, n_messages| topic(name, "sensor_msgs/msg/Image", n_messages);
        let info = |name| topic(name, "sensor_msgs/msg/CameraInfo", 90);
        let topics = [
            image("/depth/image_raw", 100),
            info("/depth/camera_info"),
            image("/left/image_rect", 80),
            info("/left/camera_info"),
        ];
        let tried = |topic_probes: Vec<TopicProbe>| {
            assert!(topic_probes.iter().all(|question| matches!(question.probe, Probe::Image)));
            assert_eq!(topic_probes.iter().map(|question| question.index).collect::<Vec<_>>(), [0, 2]);
            vec![2]
        };
        let choice = Choice::among(&topics, &[], tried).unwrap();
        assert_eq!(read(&choice), ["/left/camera_info", "/left/image_rect"]);
        assert!(choice.is_rectified);
    }

    #[test]
    fn a_named_camera_does_not_get_the_calibration_of_another() {
        let image = |name| topic(name, "sensor_msgs/msg/Image", 80);
        let info = topic("/top/camera_info", "sensor_msgs/msg/CameraInfo", 90);
        let topics = [image("/top/image_rect"), info, image("/bottom/image_rect")];
        assert_eq!(read(&choose(&topics, &["/bottom/image_rect"], &[2]).unwrap()), ["/bottom/image_rect"]);
        let both = choose(&topics, &["/bottom/image_rect", "/top/camera_info"], &[2]).unwrap();
        assert_eq!(read(&both), ["/bottom/image_rect", "/top/camera_info"]);
    }

    #[test]
    fn messages_of_ros_1_and_other_encodings_are_none_of_ours() {
        let ros1 = TopicInfo { encoding: "ros1".into(), ..topic("/scan", "sensor_msgs/LaserScan", 9) };
        assert!(read(&choose(&[ros1], &[], &[]).unwrap()).is_empty());
    }
}
