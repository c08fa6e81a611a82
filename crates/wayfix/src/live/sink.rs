use std::{sync::Arc, time::Duration};

use foxglove::{Context, WebSocketServerHandle};
use wayfix_sensor_log::{LogError, Message, MessageSink, Stamp};

use super::{Pace, audience::Audience};
use wayfix_systems::system::Stopwatch;

/// Viewers are told the time of the log this often at most: one that is told faster than it reads would be cut off.
const CLOCK_PERIOD: Duration = Duration::from_millis(20);

/// Passes messages on to the viewers, each when its time has come.
pub(super) struct LiveSink {
    pub(super) context: Arc<Context>,
    pub(super) server: Arc<WebSocketServerHandle>,
    pub(super) audience: Arc<Audience>,
    pub(super) pace: Pace,
    pub(super) clock: Clock,
}

/// The time of the log as the viewers know it.
#[derive(Default)]
pub(super) struct Clock {
    latest: Stamp,
    told: Option<Stopwatch>,
}

impl MessageSink for LiveSink {
    fn message(&mut self, message: &Message<'_>) -> Result<(), LogError> {
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
