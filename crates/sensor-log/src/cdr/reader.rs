use super::CdrError;

const HEADER_BYTES: usize = 4;

/// Reads numbers, strings and sequences from a message; allocation is bounded by the bytes present.
pub(crate) struct CdrReader<'a> {
    /// The bytes after the header.
    body: &'a [u8],
    at: usize,
    is_little_endian: bool,
}

/// Something with a fixed place in a message: its fields in the order of the definition.
pub(crate) trait FromCdr<'a>: Sized {
    /// Reads a value from the front of the remaining bytes.
    fn read(cdr: &mut CdrReader<'a>) -> Result<Self, CdrError>;
}

impl<'a> CdrReader<'a> {
    /// A whole message, with its header.
    pub(crate) fn new(message: &'a [u8]) -> Result<Self, CdrError> {
        let Some((header, body)) = message.split_first_chunk::<HEADER_BYTES>() else {
            return Err(CdrError::NoHeader { n_bytes: message.len() });
        };
        let is_little_endian = match u16::from_be_bytes([header[0], header[1]]) {
            0x0000 => false,
            0x0001 => true,
            kind => return Err(CdrError::Encapsulation { kind }),
        };
        Ok(Self { body, at: 0, is_little_endian })
    }

    pub(crate) fn u8(&mut self) -> Result<u8, CdrError> {
        self.number(u8::from_le_bytes, u8::from_be_bytes)
    }

    pub(crate) fn u16(&mut self) -> Result<u16, CdrError> {
        self.number(u16::from_le_bytes, u16::from_be_bytes)
    }

    pub(crate) fn u32(&mut self) -> Result<u32, CdrError> {
        self.number(u32::from_le_bytes, u32::from_be_bytes)
    }

    pub(crate) fn i32(&mut self) -> Result<i32, CdrError> {
        self.number(i32::from_le_bytes, i32::from_be_bytes)
    }

    pub(crate) fn f32(&mut self) -> Result<f32, CdrError> {
        self.number(f32::from_le_bytes, f32::from_be_bytes)
    }

    pub(crate) fn f64(&mut self) -> Result<f64, CdrError> {
        self.number(f64::from_le_bytes, f64::from_be_bytes)
    }

    /// Numbers of fixed count.
    pub(crate) fn f64_array<const N: usize>(&mut self) -> Result<[f64; N], CdrError> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.f64()?;
        }
        Ok(numbers)
    }

    /// A string; the length counts its final zero. One of length 0, which some writers make of the empty string, is empty.
    pub(crate) fn string(&mut self) -> Result<&'a str, CdrError> {
        let n_bytes = self.u32()?;
        let at = self.at;
        match self.take(n_bytes.into())?.split_last() {
            None => Ok(""),
            Some((0, text)) => std::str::from_utf8(text).map_err(|_| CdrError::BadString { at }),
            Some(_) => Err(CdrError::BadString { at }),
        }
    }

    /// A sequence of bytes.
    pub(crate) fn bytes(&mut self) -> Result<&'a [u8], CdrError> {
        let n_bytes = self.u32()?;
        self.take(n_bytes.into())
    }

    pub(crate) fn f32s(&mut self) -> Result<Vec<f32>, CdrError> {
        self.numbers(f32::from_le_bytes, f32::from_be_bytes)
    }

    pub(crate) fn f64s(&mut self) -> Result<Vec<f64>, CdrError> {
        self.numbers(f64::from_le_bytes, f64::from_be_bytes)
    }

    /// A sequence of structures. A length that the bytes cannot fill ends at the first structure that is not there.
    pub(crate) fn sequence<T: FromCdr<'a>>(&mut self) -> Result<Vec<T>, CdrError> {
        let n_items = self.u32()?;
        (0..n_items).map(|_| T::read(self)).collect()
    }

    fn number<T, const N: usize>(
        &mut self,
        little: fn([u8; N]) -> T,
        big: fn([u8; N]) -> T,
    ) -> Result<T, CdrError> {
        self.align(N);
        let bytes = self.take(N as u64)?;
        let bytes = bytes.try_into().expect("invariant: `take` gives as many bytes as it was asked for");
        Ok(if self.is_little_endian { little(bytes) } else { big(bytes) })
    }

    fn numbers<T, const N: usize>(
        &mut self,
        little: fn([u8; N]) -> T,
        big: fn([u8; N]) -> T,
    ) -> Result<Vec<T>, CdrError> {
        let n_items = self.u32()?;
        if n_items == 0 {
            return Ok(Vec::new()); // nothing to align
        }
        self.align(N);
        let (items, _) = self.take(u64::from(n_items) * N as u64)?.as_chunks();
        let number = if self.is_little_endian { little } else { big };
        Ok(items.iter().copied().map(number).collect())
    }

    fn align(&mut self, n_bytes: usize) {
        self.at = self.at.next_multiple_of(n_bytes);
    }

    fn take(&mut self, needed: u64) -> Result<&'a [u8], CdrError> {
        let rest = self.body.get(self.at..).unwrap_or_default();
        let n_bytes = usize::try_from(needed).ok().filter(|n_bytes| *n_bytes <= rest.len());
        let Some(n_bytes) = n_bytes else {
            return Err(CdrError::Truncated { at: self.at, needed, left: rest.len() });
        };
        self.at += n_bytes;
        Ok(&rest[..n_bytes])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_at_multiples_of_their_size_after_the_header() {
        let little = [0, 1, 0, 0, 7, 99, 99, 99, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xF0, 0x3F];
        let mut cdr = CdrReader::new(&little).unwrap();
        assert_eq!((cdr.u8(), cdr.u32(), cdr.f64()), (Ok(7), Ok(1), Ok(1.0)));
        let big = [0, 0, 0, 0, 7, 99, 99, 99, 0, 0, 0, 1, 0x3F, 0xF0, 0, 0, 0, 0, 0, 0];
        let mut cdr = CdrReader::new(&big).unwrap();
        assert_eq!((cdr.u8(), cdr.u32(), cdr.f64()), (Ok(7), Ok(1), Ok(1.0)));
    }

    #[test]
    fn a_string_ends_with_a_zero_that_its_length_counts() {
        let mut cdr = CdrReader::new(b"\0\x01\0\0\x03\0\0\0hi\0\0\0\0\0\0\x02\0\0\0hi").unwrap();
        assert_eq!((cdr.string(), cdr.string()), (Ok("hi"), Ok("")));
        assert_eq!(cdr.string(), Err(CdrError::BadString { at: 16 }));
    }

    #[test]
    fn a_sequence_that_claims_more_than_there_is_allocates_nothing() {
        let mut cdr = CdrReader::new(&[0, 1, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0, 0, 0, 0]).unwrap();
        assert_eq!(cdr.f64s(), Err(CdrError::Truncated { at: 8, needed: 8 * u64::from(u32::MAX), left: 1 }));
    }

    #[test]
    fn an_empty_sequence_of_doubles_does_not_move_what_follows() {
        let mut cdr = CdrReader::new(&[0, 1, 0, 0, 0, 0, 0, 0, 5, 0, 0, 0]).unwrap();
        assert_eq!((cdr.f64s(), cdr.u32()), (Ok(Vec::new()), Ok(5)));
    }

    #[test]
    fn other_encapsulations_are_refused_by_name() {
        assert_eq!(CdrReader::new(&[0, 1, 0]).err(), Some(CdrError::NoHeader { n_bytes: 3 }));
        for (kind, name) in [(7, "XCDR2"), (10, "XCDR2"), (3, "parameter list"), (0x55, "unknown")] {
            let error = CdrReader::new(&[0, kind, 0, 0, 1]).err().unwrap();
            assert_eq!(error, CdrError::Encapsulation { kind: kind.into() });
            assert!(error.to_string().contains(name), "{error}");
        }
    }
}
