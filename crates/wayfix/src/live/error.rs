use std::{io, net::SocketAddr};

/// Errors of the live server.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LiveServerError {
    /// Another program listens there.
    #[error("{address} is in use by another program: end that one, or choose another port")]
    InUse {
        /// The requested address.
        address: SocketAddr,
    },
    /// An operating-system error.
    #[error("cannot listen on {address}: {source}")]
    Bind {
        /// The requested address.
        address: SocketAddr,
        /// The operating-system error.
        source: io::Error,
    },
    /// The server does not start.
    #[error("the live view does not start: {0}")]
    Server(Box<foxglove::FoxgloveError>),
    /// A pace that is none.
    #[error("a pace of {factor} is not a finite number of 0 or more")]
    Pace {
        /// Times the speed of the log.
        factor: f64,
    },
}
