use std::net::{IpAddr, SocketAddr};

use anyhow::Result;
use wayfix_evaluation::terminal::print_message;
use wayfix_sensor_log::FoxgloveMessageSink;

use crate::live::{LiveServer, PlaybackPace};

// No documentation: it would become that of every command that takes these arguments.
#[derive(clap::Args)]
pub(super) struct LiveArguments {
    /// Show the run live: its messages on a WebSocket that Foxglove opens [address: 127.0.0.1:8765].
    ///
    /// PORT, IP or IP:PORT. Only this machine can connect unless an address allows others. The run begins when a viewer connects; afterwards the
    /// server keeps running until the last viewer disconnects. It runs at most as fast as `--pace`.
    #[arg(long, value_name = "ADDRESS", num_args = 0..=1, default_missing_value = "127.0.0.1", value_parser = address)]
    live: Option<SocketAddr>,
    /// Speed of `--live`: 1 as recorded, 4 four times as fast, 0 as fast as it is computed.
    #[arg(
        long,
        value_name = "FACTOR",
        default_value_t = 1.0,
        requires = "live",
        allow_negative_numbers = true
    )]
    pace: f64,
}

/// The server of a run.
pub(super) struct Live {
    server: LiveServer,
    pace: PlaybackPace,
}

impl LiveArguments {
    /// Starts the server if requested, and prints its address.
    pub(super) fn start(&self) -> Result<Option<Live>> {
        let Some(address) = self.live else { return Ok(None) };
        let live = Live { pace: PlaybackPace::new(self.pace)?, server: LiveServer::start(address)? };
        print_message(format!(
            "live: open {} in Foxglove (Open connection, Foxglove WebSocket); the run begins then",
            live.server.url()
        ));
        Ok(Some(live))
    }
}

impl Live {
    /// A message sink; returns when a viewer is connected.
    pub(super) fn sink(&self) -> Box<dyn FoxgloveMessageSink> {
        self.server.wait_for_viewer();
        self.server.sink(self.pace)
    }

    /// Keeps the end of the run in view until all viewers have gone.
    pub(super) fn stay(&self) {
        print_message("live: the end of the run stays in view until you close it there, or Ctrl-C");
        self.server.wait_until_all_left();
    }
}

fn address(text: &str) -> Result<SocketAddr, String> {
    let at = |ip: IpAddr, port: u16| SocketAddr::new(ip, port);
    let (ip, port) = (LiveServer::ADDRESS.ip(), LiveServer::ADDRESS.port());
    let read = text.parse().ok();
    let read = read.or_else(|| text.parse().ok().map(|port| at(ip, port)));
    let read = read.or_else(|| text.parse().ok().map(|ip| at(ip, port)));
    read.ok_or_else(|| "give PORT, IP or IP:PORT, for instance 8766 or 0.0.0.0:8765".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bare_port_is_local_and_bare_address_has_the_default_port() {
        let read = |text: &str| address(text).map(|address| address.to_string());
        assert_eq!(read("8766").as_deref(), Ok("127.0.0.1:8766"));
        assert_eq!(read("0.0.0.0").as_deref(), Ok("0.0.0.0:8765"));
        assert_eq!(read("[::1]:9000").as_deref(), Ok("[::1]:9000"));
        assert_eq!(read("::1").as_deref(), Ok("[::1]:8765"));
        for bad in ["", "70000", "here:8765", "127.0.0.1:x"] {
            assert!(read(bad).is_err(), "{bad:?}");
        }
    }
}
