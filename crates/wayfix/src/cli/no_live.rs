//! Replacement of `live.rs` in a build without the feature: `--live` explains how to get it.

use anyhow::Result;
use wayfix_sensor_log::FoxgloveMessageSink;

#[derive(clap::Args)]
pub(super) struct LiveArguments {
    #[arg(long, hide = true, num_args = 0..=1, value_name = "ADDRESS", default_missing_value = "", value_parser = absent)]
    live: Option<Live>,
    #[arg(long, hide = true, value_name = "FACTOR", requires = "live")]
    pace: Option<f64>,
}

/// There is none.
#[derive(Clone, Copy)]
pub(super) enum Live {}

impl LiveArguments {
    pub(super) fn start(&self) -> Result<Option<Live>> {
        let _ = self.pace;
        Ok(self.live)
    }
}

impl Live {
    pub(super) fn sink(&self) -> Box<dyn FoxgloveMessageSink> {
        match *self {}
    }

    pub(super) fn stay(&self) {
        match *self {}
    }
}

fn absent(_: &str) -> Result<Live, String> {
    Err("this wayfix was built without the live view; build it with `--features live`".to_owned())
}
