//! An encoder of plain CDR [OMG CORBA 3.3, Interoperability, 9.3] that shares nothing with the reader.

pub(crate) struct Encoder {
    body: Vec<u8>,
    is_little_endian: bool,
}

impl Encoder {
    pub(crate) fn new(is_little_endian: bool) -> Self {
        Self { body: Vec::new(), is_little_endian }
    }

    /// The whole message.
    pub(crate) fn finish(self) -> Vec<u8> {
        [&[0, self.is_little_endian.into(), 0, 0], &self.body[..]].concat()
    }

    pub(crate) fn header(&mut self, sec: i32, nanosec: u32, frame_id: &str) {
        self.number(sec.to_be_bytes());
        self.u32(nanosec);
        self.string(frame_id);
    }

    pub(crate) fn u8(&mut self, value: u8) {
        self.body.push(value);
    }

    pub(crate) fn u16(&mut self, value: u16) {
        self.number(value.to_be_bytes());
    }

    pub(crate) fn u32(&mut self, value: u32) {
        self.number(value.to_be_bytes());
    }

    pub(crate) fn f32(&mut self, value: f32) {
        self.number(value.to_be_bytes());
    }

    pub(crate) fn f64(&mut self, value: f64) {
        self.number(value.to_be_bytes());
    }

    pub(crate) fn f64s(&mut self, values: &[f64]) {
        values.iter().for_each(|value| self.f64(*value));
    }

    /// A sequence, unlike [`f64s`](Self::f64s), which are an array.
    pub(crate) fn f32s(&mut self, values: &[f32]) {
        self.u32(values.len() as u32);
        values.iter().for_each(|value| self.f32(*value));
    }

    pub(crate) fn string(&mut self, text: &str) {
        self.bytes(&[text.as_bytes(), &[0]].concat());
    }

    pub(crate) fn bytes(&mut self, bytes: &[u8]) {
        self.u32(bytes.len() as u32);
        self.body.extend(bytes);
    }

    fn number<const N: usize>(&mut self, mut big_endian: [u8; N]) {
        while !self.body.len().is_multiple_of(N) {
            self.body.push(0xAA); // padding may be anything
        }
        if self.is_little_endian {
            big_endian.reverse();
        }
        self.body.extend(big_endian);
    }
}
