use std::{
    collections::{BTreeMap, BTreeSet},
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    time::Duration,
};

use foxglove::{
    ChannelBuilder, ChannelId, Context, FoxgloveError, PartialMetadata, RawChannel, Schema, SinkId,
    websocket::{ChannelView, Client, ServerListener},
};
use wayfix_sensor_log::{ChannelKey, FoxgloveMessage};

use super::backlog::Backlog;

/// The viewers and their subscriptions.
///
/// The server would pass a message to the current subscribers. Instead it goes to each of them by name, under the same lock as the replay to
/// new ones, so that every viewer gets every message once.
#[derive(Default)]
pub(super) struct Audience {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    n_viewers: usize,
    channels: BTreeMap<ChannelKey, LiveChannel>,
}

struct LiveChannel {
    channel: Arc<RawChannel>,
    subscribers: BTreeSet<SinkId>,
    backlog: Backlog,
}

impl Audience {
    /// Passes a message on; its channel is announced first where it is new.
    pub(super) fn send(
        &self,
        context: &Arc<Context>,
        message: &FoxgloveMessage<'_>,
    ) -> Result<(), FoxgloveError> {
        let mut state = self.state();
        let key = message.channel();
        if !state.channels.contains_key(&key) {
            state.channels.insert(key.clone(), LiveChannel::announce(context, message)?);
        }
        if let Some(live) = state.channels.get_mut(&key) {
            let time = message.stamp.nanoseconds();
            live.backlog.push(time, message.data);
            live.subscribers.iter().for_each(|viewer| send_to(&live.channel, *viewer, time, message.data));
        }
        Ok(())
    }

    /// Returns when a viewer is connected.
    pub(super) fn wait_for_viewer(&self) {
        let nobody = |state: &mut State| state.n_viewers == 0;
        drop(self.changed.wait_while(self.state(), nobody));
    }

    /// Returns when no viewer was connected for `grace`, which covers a page reload.
    pub(super) fn wait_until_all_left(&self, grace: Duration) {
        let mut state = self.state();
        loop {
            let somebody = |state: &mut State| state.n_viewers > 0;
            let left = self.changed.wait_while(state, somebody).unwrap_or_else(PoisonError::into_inner);
            let nobody = |state: &mut State| state.n_viewers == 0;
            let back = self.changed.wait_timeout_while(left, grace, nobody);
            let (now, waited) = back.unwrap_or_else(PoisonError::into_inner);
            if waited.timed_out() {
                return;
            }
            state = now;
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // A panic leaves the state consistent.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn with_channel(&self, id: ChannelId, change: impl FnOnce(&mut LiveChannel)) {
        let mut state = self.state();
        if let Some(live) = state.channels.values_mut().find(|live| live.channel.id() == id) {
            change(live);
        }
    }
}

impl ServerListener for Audience {
    fn on_client_connect(&self) {
        self.state().n_viewers += 1;
        self.changed.notify_all();
    }

    fn on_client_disconnect(&self) {
        let mut state = self.state();
        state.n_viewers = state.n_viewers.saturating_sub(1);
        self.changed.notify_all();
    }

    fn on_subscribe(&self, client: Client, channel: ChannelView) {
        let Some(viewer) = client.sink_id() else { return };
        self.with_channel(channel.id(), |live| {
            let LiveChannel { channel, subscribers, backlog } = live;
            backlog.replay(|time, data| send_to(channel, viewer, time, data));
            subscribers.insert(viewer);
        });
    }

    fn on_unsubscribe(&self, client: Client, channel: ChannelView) {
        let Some(viewer) = client.sink_id() else { return };
        self.with_channel(channel.id(), |live| {
            live.subscribers.remove(&viewer);
        });
    }
}

impl LiveChannel {
    fn announce(context: &Arc<Context>, message: &FoxgloveMessage<'_>) -> Result<Self, FoxgloveError> {
        let schema = Schema::new(message.schema, FoxgloveMessage::ENCODING, message.descriptors.to_vec());
        let channel = ChannelBuilder::new(message.topic)
            .context(context)
            .schema(schema)
            .message_encoding(FoxgloveMessage::ENCODING)
            .metadata(message.metadata.clone())
            .build_raw()?;
        Ok(Self { channel, subscribers: BTreeSet::new(), backlog: Backlog::default() })
    }
}

fn send_to(channel: &RawChannel, viewer: SinkId, time: u64, data: &[u8]) {
    channel.log_with_meta_to_sink(data, PartialMetadata::with_log_time(time), Some(viewer));
}
