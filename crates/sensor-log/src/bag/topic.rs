use std::fmt;

/// A topic of a ROS 2 bag and its use.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct BagTopic {
    /// Its name.
    pub name: String,
    /// Type of its messages.
    pub schema: String,
    /// Number of messages.
    pub n_messages: u64,
    /// Whether they are read.
    pub r#use: TopicUse,
}

/// Use of a topic.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TopicUse {
    /// It is read, as this.
    Read(&'static str),
    /// It could be read as this kind, but another topic is.
    NotChosen(&'static str),
    /// Messages of this type, or of this name, are not read.
    NotUnderstood,
    /// It has no messages.
    Empty,
}

/// A topic as a file announces it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TopicInfo {
    pub(crate) name: String,
    pub(crate) schema: String,
    pub(crate) encoding: String,
    pub(crate) n_messages: u64,
}

impl TopicInfo {
    /// Whether two channels are one topic: publishers of one may have a channel each.
    pub(crate) fn is_same_as(&self, other: &Self) -> bool {
        self.name == other.name && self.schema == other.schema
    }

    /// Whether its messages have the encoding of ROS 2.
    pub(super) fn is_cdr(&self) -> bool {
        self.encoding == "cdr"
    }
}

impl fmt::Display for BagTopic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, schema, n_messages, r#use } = self;
        write!(f, "{name:32} {schema:44} {n_messages:7} messages  ")?;
        match r#use {
            TopicUse::Read(what) => f.write_str(what),
            TopicUse::NotChosen(what) => write!(f, "not read; choose it as {what} with --topic {name}"),
            TopicUse::NotUnderstood => f.write_str("not understood"),
            TopicUse::Empty => f.write_str("nothing to read"),
        }
    }
}
