use super::TopicInfo;
use super::kind::Kind;
use crate::ros::RosSchema;

/// A topic that can be read as something.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate<'a> {
    /// Which of the file's topics it is.
    pub(super) index: usize,
    pub(super) topic: &'a TopicInfo,
    pub(super) schema: RosSchema,
    pub(super) kind: Kind,
}

impl<'a> Candidate<'a> {
    pub(super) fn of((index, topic): (usize, &'a TopicInfo)) -> Option<Self> {
        if !topic.is_cdr() || topic.n_messages == 0 {
            return None;
        }
        let schema = RosSchema::named(&topic.schema)?;
        let kind = Kind::of(schema, &topic.name)?;
        Some(Self { index, topic, schema, kind })
    }

    pub(super) fn key(&self) -> (String, String) {
        (self.topic.name.clone(), self.topic.schema.clone())
    }

    pub(super) fn is_odometry(&self) -> bool {
        self.schema == RosSchema::Odometry
    }
}

/// The one with the most messages, of equals the first; measured motion before commands.
pub(super) fn best<'a>(candidates: impl IntoIterator<Item = Candidate<'a>>) -> Option<Candidate<'a>> {
    let rank = |schema| match schema {
        RosSchema::Twist => 2,
        RosSchema::TwistStamped => 1,
        _ => 0,
    };
    let order = |it: &Candidate<'a>| (rank(it.schema), std::cmp::Reverse(it.topic.n_messages), it.index);
    candidates.into_iter().min_by_key(order)
}
