//! From the bytes of MCAP files to records in time order.

pub(super) mod chunk;
pub(super) mod decode;
pub(super) mod fields;
pub(super) mod file;
pub(super) mod folder;
pub(super) mod parts;
pub(super) mod pending_cloud;
pub(super) mod reader;
pub(super) mod reorder;
pub(super) mod routes;
pub(super) mod stream;
pub(super) mod topic_clock;
pub(super) mod topic_listing;
