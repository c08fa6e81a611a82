//! A map's form in files: colours by name, polygons and posts in lists of their own.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::ColorMap;
use crate::{ColorId, ColorMapError, ColoredShape, PostBand};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MapFile {
    colors: Vec<String>,
    #[serde(default, rename = "polygon")]
    polygons: Vec<PolygonEntry>,
    #[serde(default, rename = "post")]
    posts: Vec<PostEntry>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PolygonEntry {
    color: String,
    vertices: Vec<[f64; 3]>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PostEntry {
    x: f64,
    y: f64,
    radius: f64,
    bands: Vec<BandEntry>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct BandEntry {
    color: String,
    from: f64,
    to: f64,
}

impl TryFrom<MapFile> for ColorMap {
    type Error = ColorMapError;

    fn try_from(file: MapFile) -> Result<Self, ColorMapError> {
        let color = |name: String| match file.colors.iter().position(|color| *color == name) {
            // An index beyond a byte means too many colours, which `ColorMap::new` rejects.
            Some(index) => Ok(ColorId(u8::try_from(index).unwrap_or(u8::MAX))),
            None => Err(ColorMapError::UnknownColorName { name }),
        };
        let mut shapes = Vec::with_capacity(file.polygons.len() + file.posts.len());
        for PolygonEntry { color: name, vertices } in file.polygons {
            let vertices = vertices.into_iter().map(Vector3::from).collect();
            shapes.push(ColoredShape::Polygon { color: color(name)?, vertices });
        }
        for PostEntry { x, y, radius, bands } in file.posts {
            let band = |b: BandEntry| Ok(PostBand { color: color(b.color)?, from: b.from, to: b.to });
            let bands = bands.into_iter().map(band).collect::<Result<_, ColorMapError>>()?;
            shapes.push(ColoredShape::Post { x, y, radius, bands });
        }
        Self::new(file.colors, shapes)
    }
}

impl From<&ColorMap> for MapFile {
    fn from(map: &ColorMap) -> Self {
        let name = |color: ColorId| map.colors()[color.index()].clone();
        let mut file = Self { colors: map.colors().to_vec(), polygons: Vec::new(), posts: Vec::new() };
        for shape in map.shapes() {
            match shape {
                ColoredShape::Polygon { color, vertices } => {
                    let vertices = vertices.iter().map(|&v| v.into()).collect();
                    file.polygons.push(PolygonEntry { color: name(*color), vertices });
                }
                ColoredShape::Post { x, y, radius, bands } => {
                    let entry = |b: &PostBand| BandEntry { color: name(b.color), from: b.from, to: b.to };
                    let bands = bands.iter().map(entry).collect();
                    file.posts.push(PostEntry { x: *x, y: *y, radius: *radius, bands });
                }
            }
        }
        file
    }
}

impl Serialize for ColorMap {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        MapFile::from(self).serialize(serializer)
    }
}

/// Checked as by [`ColorMap::new`].
impl<'de> Deserialize<'de> for ColorMap {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        MapFile::deserialize(deserializer)?.try_into().map_err(serde::de::Error::custom)
    }
}
