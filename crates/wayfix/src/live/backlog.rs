use std::collections::VecDeque;

/// Messages that are kept before anybody has subscribed to their topic.
const MOST_MESSAGES: usize = 512;
const MOST_BYTES: usize = 16 << 20;

/// Past messages for late subscribers.
///
/// A topic is announced with its first message, so every viewer subscribes late. The first subscriber gets all of it (the latest 512 messages, or 16
/// MiB), a later one the last message, which includes the map, the calibration and the walls.
#[derive(Debug, Default)]
pub(super) struct Backlog {
    /// Log time, ns, and bytes.
    messages: VecDeque<(u64, Box<[u8]>)>,
    n_bytes: usize,
    was_heard: bool,
}

impl Backlog {
    pub(super) fn push(&mut self, time: u64, data: &[u8]) {
        self.n_bytes += data.len();
        self.messages.push_back((time, data.into()));
        let most_messages = if self.was_heard { 1 } else { MOST_MESSAGES };
        while self.messages.len() > most_messages || (self.messages.len() > 1 && self.n_bytes > MOST_BYTES) {
            self.drop_oldest();
        }
    }

    /// Sends the stored messages to a new subscriber.
    pub(super) fn replay(&mut self, mut send: impl FnMut(u64, &[u8])) {
        self.messages.iter().for_each(|(time, data)| send(*time, data));
        self.was_heard = true;
        while self.messages.len() > 1 {
            self.drop_oldest();
        }
    }

    fn drop_oldest(&mut self) {
        self.n_bytes -= self.messages.pop_front().map_or(0, |(_, data)| data.len());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(backlog: &mut Backlog) -> Vec<u64> {
        let mut times = Vec::new();
        backlog.replay(|time, _| times.push(time));
        times
    }

    #[test]
    fn the_first_gets_everything_and_a_later_one_the_last_message() {
        let mut backlog = Backlog::default();
        (0..5).for_each(|time| backlog.push(time, b"abc"));
        assert_eq!(times(&mut backlog), [0, 1, 2, 3, 4]);
        backlog.push(5, b"abc");
        backlog.push(6, b"abc");
        assert_eq!(times(&mut backlog), [6]);
        assert_eq!(times(&mut backlog), [6], "and so does the next");
    }

    #[test]
    fn a_topic_that_nobody_wants_does_not_fill_the_memory() {
        let mut many = Backlog::default();
        (0..10_000).for_each(|time| many.push(time, b"x"));
        assert_eq!((many.messages.len(), many.n_bytes), (MOST_MESSAGES, MOST_MESSAGES));
        let mut large = Backlog::default();
        (0..5).for_each(|time| large.push(time, &vec![0; MOST_BYTES / 2]));
        assert_eq!(times(&mut large), [3, 4]);
        large.push(5, &vec![0; 2 * MOST_BYTES]);
        assert_eq!(times(&mut large), [5], "the last is always there");
    }
}
