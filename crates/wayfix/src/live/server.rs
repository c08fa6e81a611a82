use std::{
    io,
    net::{IpAddr, SocketAddr},
    sync::Arc,
    time::Duration,
};

use foxglove::{Context, FoxgloveError, WebSocketServer, WebSocketServerHandle, websocket::Capability};
use wayfix_sensor_log::FoxgloveMessageSink;

use super::{
    LiveServerError, PlaybackPace,
    audience::Audience,
    sink::{Clock, LiveSink},
};

/// A viewer that reloads its page reconnects within this time.
const GRACE: Duration = Duration::from_secs(2);

/// A WebSocket on which Foxglove, and other programs with its protocol, show a run live.
///
/// It is read-only: viewers cannot change or publish anything.
/// ```
/// use wayfix::live::{LiveServerError, LiveServer, PlaybackPace};
/// # use wayfix_slam_system::{points::PointSlamFrontEnd, slam::SlamEstimateRecorder};
/// let server = LiveServer::start(([127, 0, 0, 1], 0).into())?; // port 0: any that is free
/// let estimates = SlamEstimateRecorder::<PointSlamFrontEnd>::new(vec![server.sink(PlaybackPace::new(1.0)?)], wayfix_sensor_log::LogFormat::Utias)?;
/// assert!(server.url().starts_with("ws://127.0.0.1:"));
/// let again = LiveServer::start(server.address());
/// assert!(matches!(again, Err(LiveServerError::InUse { .. })));
/// estimates.finish()?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct LiveServer {
    context: Arc<Context>,
    handle: Arc<WebSocketServerHandle>,
    audience: Arc<Audience>,
    address: SocketAddr,
}

impl LiveServer {
    /// Default address: this machine only, with Foxglove's default port.
    pub const ADDRESS: SocketAddr = SocketAddr::new(IpAddr::V4(std::net::Ipv4Addr::LOCALHOST), 8765);

    /// Listens at `address`.
    ///
    /// # Errors
    /// Returns [`LiveServerError::InUse`], [`LiveServerError::Bind`], [`LiveServerError::Server`].
    pub fn start(address: SocketAddr) -> Result<Self, LiveServerError> {
        let (context, audience) = (Context::new(), Arc::new(Audience::default()));
        let listener = Arc::clone(&audience);
        let host = match address.ip() {
            IpAddr::V4(ip) => ip.to_string(),
            IpAddr::V6(ip) => format!("[{ip}]"),
        };
        let server = WebSocketServer::new()
            .name("wayfix")
            .context(&context)
            .bind(host, address.port())
            .capabilities([Capability::Time])
            .listener(listener);
        let handle = server.start_blocking().map_err(|error| match error {
            FoxgloveError::Bind(source) if source.kind() == io::ErrorKind::AddrInUse => {
                LiveServerError::InUse { address }
            }
            FoxgloveError::Bind(source) => LiveServerError::Bind { address, source },
            other => LiveServerError::Server(Box::new(other)),
        })?;
        let address = SocketAddr::new(address.ip(), handle.port());
        Ok(Self { context, handle: Arc::new(handle), audience, address })
    }

    /// The listening address.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// The URL for viewers.
    pub fn url(&self) -> String {
        format!("ws://{}", self.address)
    }

    /// Takes messages and passes them on at a pace.
    pub fn sink(&self, pace: PlaybackPace) -> Box<dyn FoxgloveMessageSink> {
        Box::new(LiveSink {
            context: Arc::clone(&self.context),
            server: Arc::clone(&self.handle),
            audience: Arc::clone(&self.audience),
            pace,
            clock: Clock::default(),
        })
    }

    /// Returns when a viewer is connected.
    pub(crate) fn wait_for_viewer(&self) {
        self.audience.wait_for_viewer();
    }

    /// Returns when no viewer is connected.
    pub(crate) fn wait_until_all_left(&self) {
        self.audience.wait_until_all_left(GRACE);
    }
}
