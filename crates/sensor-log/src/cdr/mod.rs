//! Common Data Representation, the encoding of ROS 2 messages [OMG CORBA 3.3, Interoperability, 9.3; OMG DDSI-RTPS 2.5, 10.5].
//!
//! Four bytes of header tell the byte order. Every number then stands at a multiple of its size, counted from the byte after the header; a
//! string and a sequence begin with their length in 32 bits.

mod error;
mod reader;

pub use error::CdrError;
pub(crate) use reader::{CdrReader, FromCdr};
