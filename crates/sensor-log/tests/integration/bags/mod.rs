//! ROS 2 bags: messages, transforms, split bags, and what robots in the field record.

mod external_sensors;
mod field_bags;
mod ros_bags;
mod ros_messages;
mod split_bags;
