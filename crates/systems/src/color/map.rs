use std::path::Path;

use anyhow::{Context, Result};
use wayfix_color_map::{ColorMap, ColoredShape};
use wayfix_sensor_log::read_text;

/// Reads a map of coloured surfaces from TOML or, with the extension `.json`, from JSON.
///
/// # Errors
/// Returns an error if the file cannot be read or parsed, or if a surface is invalid.
pub fn read_map(path: &Path) -> Result<ColorMap> {
    let text = read_text(path).with_context(|| format!("cannot read the map {}", path.display()))?;
    let map = if path.extension().is_some_and(|extension| extension == "json") {
        serde_json::from_str(&text).map_err(anyhow::Error::from)
    } else {
        toml::from_str(&text).map_err(anyhow::Error::from)
    };
    map.with_context(|| format!("the map {} is not usable", path.display()))
}

/// The outlines of the map's surfaces seen from above, to draw paths on.
pub fn field_lines(map: &ColorMap) -> Vec<Vec<(f64, f64)>> {
    const CORNERS: u32 = 12;
    let outline = |shape: &ColoredShape| match shape {
        ColoredShape::Polygon { vertices, .. } => {
            vertices.iter().chain(vertices.first()).map(|vertex| (vertex.x, vertex.y)).collect()
        }
        ColoredShape::Post { x, y, radius, .. } => (0..=CORNERS)
            .map(|k| {
                let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(CORNERS)).sin_cos();
                (x + radius * cos, y + radius * sin)
            })
            .collect(),
    };
    map.shapes().iter().map(outline).collect()
}
