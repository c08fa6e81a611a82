//! From records to MCAP files and streams.

pub(super) mod drawing;
pub(super) mod encode;
pub(super) mod sink;
pub(super) mod writer;
