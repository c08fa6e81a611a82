//! Common Data Representation, the encoding of ROS 2 messages [OMG CORBA 3.3, Interoperability, 9.3; OMG DDSI-RTPS 2.5, 10.5].
//!
//! A four-byte header gives the byte order. Every number is aligned to its size, counted from the byte after the header. Strings and
//! sequences begin with their length in 32 bits.

mod error;
mod reader;

pub use error::CdrError;
pub(crate) use reader::{CdrReader, FromCdr};
