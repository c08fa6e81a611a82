/// Reads little-endian fields from the front of a slice; `None` if it is too short.
///
/// The parser of the mcap crate allocates the claimed length of a string; this one borrows.
pub(in crate::mcap_log) struct Fields<'a>(pub(in crate::mcap_log) &'a [u8]);

impl<'a> Fields<'a> {
    pub(in crate::mcap_log) fn u8(&mut self) -> Option<u8> {
        self.array().map(u8::from_le_bytes)
    }
    pub(in crate::mcap_log) fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_le_bytes)
    }
    pub(in crate::mcap_log) fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }
    pub(in crate::mcap_log) fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }
    /// A string: its length in 32 bits, then UTF-8.
    pub(in crate::mcap_log) fn str(&mut self) -> Option<&'a str> {
        std::str::from_utf8(self.sized()?).ok()
    }
    /// Bytes after their length in 32 bits.
    pub(in crate::mcap_log) fn sized(&mut self) -> Option<&'a [u8]> {
        let n_bytes = self.u32()?;
        self.take(n_bytes.into())
    }
    /// Bytes after their length in 64 bits.
    pub(in crate::mcap_log) fn bytes(&mut self) -> Option<&'a [u8]> {
        let n_bytes = self.u64()?;
        self.take(n_bytes)
    }
    /// A map of strings: its length in 32 bits, then keys and values in turn.
    pub(in crate::mcap_log) fn pairs(
        &mut self,
    ) -> Option<impl Iterator<Item = (&'a str, &'a str)> + use<'a>> {
        let mut pairs = Fields(self.sized()?);
        Some(std::iter::from_fn(move || Some((pairs.str()?, pairs.str()?))))
    }
    fn take(&mut self, n_bytes: u64) -> Option<&'a [u8]> {
        let (bytes, rest) = self.0.split_at_checked(usize::try_from(n_bytes).ok()?)?;
        self.0 = rest;
        Some(bytes)
    }
    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (array, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*array)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_string_longer_than_the_record_is_none() {
        let mut fields = Fields(b"\x07\x00\x02\x00\x00\x00hi\xff\xff\xff\xffx");
        assert_eq!((fields.u16(), fields.str(), fields.str()), (Some(7), Some("hi"), None));
    }
}
