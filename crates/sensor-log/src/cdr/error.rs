/// Errors of decoding a CDR message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CdrError {
    /// Fewer bytes than the header has.
    #[error("{n_bytes} bytes, a CDR header alone has 4")]
    NoHeader {
        /// Bytes that are there.
        n_bytes: usize,
    },
    /// Another encoding than plain CDR: parameter lists, or the second version (XCDR2).
    #[error("encapsulation {kind:#06x} is {}; plain CDR (0x0000, 0x0001) is read", encapsulation_name(*kind))]
    Encapsulation {
        /// The first two bytes of the message, big endian.
        kind: u16,
    },
    /// The message ends, or a length claims more than is there.
    #[error("{needed} bytes needed at byte {at}, {left} left")]
    Truncated {
        /// Offset from the byte after the header.
        at: usize,
        /// Bytes that should be there.
        needed: u64,
        /// Bytes that are there.
        left: usize,
    },
    /// A string that is not UTF-8 or lacks its final zero.
    #[error("string at byte {at} is not UTF-8 with a final zero")]
    BadString {
        /// Offset of its first character from the byte after the header.
        at: usize,
    },
}

/// [OMG DDS-XTypes 1.3, Table 60]
fn encapsulation_name(kind: u16) -> &'static str {
    match kind {
        0x0002 | 0x0003 => "a parameter list (PL_CDR)",
        0x0006..=0x000b => "XCDR2",
        _ => "unknown",
    }
}
