use std::{sync::Arc, time::Duration};

use foxglove::{Context, WebSocketServerHandle};
use wayfix_sensor_log::{FoxgloveMessage, FoxgloveMessageSink, LogError, Stamp};
use wayfix_system_core::Stopwatch;

use super::{PlaybackPace, audience::Audience};

/// Minimum period of clock messages to viewers; a viewer that reads more slowly would be disconnected.
const CLOCK_PERIOD: Duration = Duration::from_millis(20);

/// Passes messages to the viewers at their due times.
pub(super) struct LiveSink {
    pub(super) context: Arc<Context>,
    pub(super) server: Arc<WebSocketServerHandle>,
    pub(super) audience: Arc<Audience>,
    pub(super) pace: PlaybackPace,
    pub(super) clock: Clock,
}

/// The log time last sent to the viewers.
#[derive(Default)]
pub(super) struct Clock {
    latest: Stamp,
    told: Option<Stopwatch>,
}

impl FoxgloveMessageSink for LiveSink {
    fn message(&mut self, message: &FoxgloveMessage<'_>) -> Result<(), LogError> {
        self.pace.wait_for(message.stamp);
        if self.clock.should_tell(message.stamp) {
            self.server.broadcast_time(message.stamp.nanoseconds());
        }
        self.audience.send(&self.context, message).map_err(|error| LogError::Sink(error.into()))
    }
}

impl Clock {
    fn should_tell(&mut self, stamp: Stamp) -> bool {
        let is_news = stamp > self.latest && self.told.is_none_or(|told| told.elapsed() >= CLOCK_PERIOD);
        if is_news {
            self.latest = stamp;
            self.told = Some(Stopwatch::start());
        }
        is_news
    }
}
