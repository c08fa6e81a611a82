//! Live view of a run: the messages of the MCAP file, on a WebSocket that Foxglove opens.
//!
//! [`LiveServer`] listens, its [`sink`](LiveServer::sink) is one of the [`Sinks`](wayfix_sensor_log::MessageSinks) of an
//! [`EstimateRecorder`](wayfix_system_core::EstimateRecorder). The systems do not depend on it. Requires the feature `live`.

mod audience;
mod backlog;
mod error;
mod pace;
mod server;
mod sink;

pub use error::LiveServerError;
pub use pace::PlaybackPace;
pub use server::LiveServer;
