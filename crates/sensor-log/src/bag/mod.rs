//! ROS 2 bags: which of their topics are read, and what their messages become.

mod camera;
mod candidate;
mod choice;
mod kind;
mod motion;
mod records;
mod scan;
mod topic;
mod transforms;
mod trial;

pub(crate) use choice::Choice;
pub(crate) use kind::BagRoute;
pub(crate) use records::BagRecords;
pub(crate) use topic::SurveyedTopic;
pub use topic::{Topic, TopicUse};
pub(crate) use trial::Question;
