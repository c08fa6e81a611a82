use super::LinearRgb;

/// ITU-R BT.601 in full range, as in JPEG files, with U and V about 0.
pub(super) fn from_rgb(rgb: &LinearRgb) -> LinearRgb {
    let y = 0.299 * rgb.x + 0.587 * rgb.y + 0.114 * rgb.z;
    LinearRgb::new(y, (rgb.z - y) / 1.772, (rgb.x - y) / 1.402)
}

/// The inverse, as bytes.
pub(super) fn to_rgb(y: f64, u: f64, v: f64) -> [u8; 3] {
    let red = y + 1.402 * v;
    let blue = y + 1.772 * u;
    let green = (y - 0.299 * red - 0.114 * blue) / 0.587;
    [red, green, blue].map(|value| (value + 0.5) as u8)
}
