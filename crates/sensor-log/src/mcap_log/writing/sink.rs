use std::collections::BTreeMap;

use crate::{LogError, LogFormat, Stamp};

/// A Foxglove message, encoded as protobuf.
#[derive(Clone, Copy, Debug)]
pub struct FoxgloveMessage<'a> {
    /// Topic of the message.
    pub topic: &'a str,
    /// Name of its schema, for instance `foxglove.PoseInFrame`.
    pub schema: &'a str,
    /// The schema itself: a file descriptor set.
    pub descriptors: &'a [u8],
    /// Metadata common to all messages of the channel.
    pub metadata: &'a BTreeMap<String, String>,
    /// Time of the message.
    pub stamp: Stamp,
    /// Its bytes.
    pub data: &'a [u8],
}

impl FoxgloveMessage<'_> {
    /// Encoding of schemas and messages.
    pub const ENCODING: &'static str = "protobuf";

    /// The channel of the message.
    pub fn channel(&self) -> ChannelKey {
        ChannelKey {
            topic: self.topic.to_owned(),
            schema: self.schema.to_owned(),
            metadata: self.metadata.clone(),
        }
    }
}

/// Identity of a channel.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ChannelKey {
    topic: String,
    schema: String,
    metadata: BTreeMap<String, String>,
}

/// Destination of messages: a file, a viewer, or several of them.
/// ```
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_sensor_log::{LogError, FoxgloveMessage, FoxgloveMessageSink, FoxgloveMessageWriter, Stamp};
/// #[derive(Default)]
/// struct Count(usize);
/// impl FoxgloveMessageSink for Count {
///     fn message(&mut self, message: &FoxgloveMessage<'_>) -> Result<(), LogError> {
///         assert_eq!((message.topic, message.schema), ("/pose", "foxglove.PoseInFrame"));
///         self.0 += 1;
///         Ok(())
///     }
/// }
/// let mut writer = FoxgloveMessageWriter::into_sink(Count::default());
/// writer.pose_in_frame("/pose", Stamp::from_nanoseconds(5), "world", &Pose2::new(1.0, 2.0, 0.5))?;
/// assert_eq!(writer.sink().0, 1);
/// writer.finish()?;
/// # Ok::<(), LogError>(())
/// ```
pub trait FoxgloveMessageSink {
    /// Takes a message.
    ///
    /// # Errors
    /// Returns an error if it cannot be passed on.
    fn message(&mut self, message: &FoxgloveMessage<'_>) -> Result<(), LogError>;

    /// Announces the original format of the records, before the first message.
    /// # Errors
    /// Returns an error if that cannot be passed on.
    fn origin(&mut self, origin: LogFormat) -> Result<(), LogError> {
        let _ = origin;
        Ok(())
    }

    /// Ends the output.
    /// # Errors
    /// Returns an error if the output cannot be completed.
    fn finish(self: Box<Self>) -> Result<(), LogError> {
        Ok(())
    }
}

/// Several sinks; each gets every message.
pub type MessageSinks = Vec<Box<dyn FoxgloveMessageSink>>;

impl FoxgloveMessageSink for MessageSinks {
    fn message(&mut self, message: &FoxgloveMessage<'_>) -> Result<(), LogError> {
        self.iter_mut().try_for_each(|sink| sink.message(message))
    }

    fn origin(&mut self, origin: LogFormat) -> Result<(), LogError> {
        self.iter_mut().try_for_each(|sink| sink.origin(origin))
    }

    fn finish(self: Box<Self>) -> Result<(), LogError> {
        self.into_iter().try_for_each(FoxgloveMessageSink::finish)
    }
}
