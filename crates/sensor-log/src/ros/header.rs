use crate::cdr::{CdrError, CdrReader, FromCdr};

/// `std_msgs/Header`: stamp and frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Header<'a> {
    /// Seconds.
    pub sec: i32,
    /// Nanoseconds of the second.
    pub nanosec: u32,
    /// The frame that the message is given in.
    pub frame_id: &'a str,
}

impl<'a> FromCdr<'a> for Header<'a> {
    fn read(cdr: &mut CdrReader<'a>) -> Result<Self, CdrError> {
        Ok(Self { sec: cdr.i32()?, nanosec: cdr.u32()?, frame_id: cdr.string()? })
    }
}
