//! ROS 2 bags: selection of topics, and conversion of messages.

mod camera;
mod candidate;
mod choice;
mod kind;
mod measurement;
mod motion;
mod probe;
mod records;
mod scan;
mod topic;
mod transforms;

pub(crate) use choice::Choice;
pub(crate) use kind::BagRoute;
pub(crate) use probe::TopicProbe;
pub(crate) use records::BagRecords;
pub(crate) use topic::TopicInfo;
pub use topic::{BagTopic, TopicUse};
