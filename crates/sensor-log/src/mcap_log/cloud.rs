//! Packing numbers into the bytes of a `foxglove.PointCloud` and out of them.

use foxglove::bytes::Bytes;
use foxglove::messages::packed_element_field::NumericType;
use foxglove::messages::{PackedElementField, PointCloud, Timestamp};

use super::writing::encode;

/// Name and type of one column; columns are packed without gaps.
pub(super) type Column = (&'static str, NumericType);

/// A cloud with one point per item, written by `push_point` in the order of `columns`.
pub(super) fn pack<T>(
    timestamp: Timestamp,
    frame: &str,
    columns: &[Column],
    items: &[T],
    push_point: impl Fn(&T, &mut Vec<u8>),
) -> PointCloud {
    let mut fields = Vec::with_capacity(columns.len());
    let mut offset = 0;
    for (name, numeric_type) in columns {
        fields.push(PackedElementField { name: (*name).to_owned(), offset, r#type: (*numeric_type).into() });
        offset += width(*numeric_type) as u32;
    }
    let mut data = Vec::with_capacity(items.len() * offset as usize);
    for item in items {
        push_point(item, &mut data);
    }
    PointCloud {
        timestamp: Some(timestamp),
        frame_id: frame.to_owned(),
        pose: Some(encode::identity()),
        point_stride: offset,
        fields,
        data: Bytes::from(data),
    }
}

/// The points of a cloud as byte slices; `None` if its sizes are inconsistent.
pub(super) fn points(cloud: &PointCloud) -> Option<impl Iterator<Item = &[u8]>> {
    let stride = cloud.point_stride as usize;
    let fits = if stride == 0 { cloud.data.is_empty() } else { cloud.data.len().is_multiple_of(stride) };
    fits.then(|| cloud.data.chunks_exact(stride.max(1)))
}

/// Position of a column in each point.
#[derive(Clone, Copy)]
pub(super) struct PointField {
    offset: usize,
    numeric_type: NumericType,
}

impl PointField {
    /// The column `name`; `None` if it is missing or does not fit into a point.
    pub(super) fn of(cloud: &PointCloud, name: &str) -> Option<Self> {
        let field = cloud.fields.iter().find(|field| field.name == name)?;
        let numeric_type = NumericType::try_from(field.r#type).ok()?;
        let offset = field.offset as usize;
        (offset.checked_add(width(numeric_type))? <= cloud.point_stride as usize)
            .then_some(Self { offset, numeric_type })
    }

    /// A floating-point number; `None` if the column has another type.
    pub(super) fn float(self, point: &[u8]) -> Option<f64> {
        match self.numeric_type {
            NumericType::Float64 => self.array(point).map(f64::from_le_bytes),
            NumericType::Float32 => self.array(point).map(|bytes| f32::from_le_bytes(bytes).into()),
            _ => None,
        }
    }

    /// A whole number; `None` if the column has another type.
    pub(super) fn whole(self, point: &[u8]) -> Option<u32> {
        match self.numeric_type {
            NumericType::Uint32 => self.array(point).map(u32::from_le_bytes),
            NumericType::Uint16 => self.array(point).map(|bytes| u16::from_le_bytes(bytes).into()),
            NumericType::Uint8 => self.array(point).map(|bytes| u8::from_le_bytes(bytes).into()),
            _ => None,
        }
    }

    fn array<const N: usize>(self, point: &[u8]) -> Option<[u8; N]> {
        point.get(self.offset..)?.first_chunk().copied()
    }
}

fn width(numeric_type: NumericType) -> usize {
    match numeric_type {
        NumericType::Unknown => 0,
        NumericType::Uint8 | NumericType::Int8 => 1,
        NumericType::Uint16 | NumericType::Int16 => 2,
        NumericType::Uint32 | NumericType::Int32 | NumericType::Float32 => 4,
        NumericType::Float64 => 8,
    }
}
