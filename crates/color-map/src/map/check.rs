//! Validation of shapes.

use nalgebra::Vector3;

use super::{Plane, Prism, layer::FLAT};
use crate::{ColorId, ColorMapError, PostBand};

/// Largest coordinate, m: beyond it, a double cannot resolve the tolerances above.
const MAX_COORDINATE: f64 = 1e6;
/// Most colours: a grey label image has one value for each and one for none.
const MAX_COLORS: usize = 255;

pub(super) fn colors(names: &[String]) -> Result<(), ColorMapError> {
    if names.len() > MAX_COLORS {
        return Err(ColorMapError::TooManyColors { limit: MAX_COLORS, got: names.len() });
    }
    match names.iter().enumerate().find(|(i, name)| names[..*i].contains(name)) {
        Some((_, name)) => Err(ColorMapError::DuplicateColor { name: name.clone() }),
        None => Ok(()),
    }
}

pub(super) fn color(shape: usize, color: ColorId, n_colors: usize) -> Result<(), ColorMapError> {
    if color.index() < n_colors {
        Ok(())
    } else {
        Err(ColorMapError::UnknownColor { shape, color: color.0, n_colors })
    }
}

/// The plane of a polygon that is finite, flat, convex and has an area.
pub(super) fn polygon(shape: usize, vertices: &[Vector3<f64>]) -> Result<Plane, ColorMapError> {
    if vertices.len() < 3 {
        return Err(ColorMapError::TooFewVertices { shape, got: vertices.len() });
    }
    for value in vertices.iter().flat_map(|v| v.iter().copied()) {
        coordinate(shape, value)?;
    }
    let plane = newell_plane(shape, vertices)?;
    for (vertex, v) in vertices.iter().enumerate() {
        let distance_m = plane.distance(v).abs();
        if distance_m > FLAT {
            return Err(ColorMapError::NotPlanar { shape, vertex, distance_m });
        }
    }
    for (a, b) in edges(vertices) {
        let Some(inwards) = plane.normal.cross(&(b - a)).try_normalize(FLAT) else {
            return Err(ColorMapError::Value {
                shape,
                what: "edge, m",
                value: (b - a).norm(),
                must: "above 1e-6",
            });
        };
        for (vertex, v) in vertices.iter().enumerate() {
            let distance_m = -inwards.dot(&(v - a));
            if distance_m > FLAT {
                return Err(ColorMapError::NotConvex { shape, vertex, distance_m });
            }
        }
    }
    Ok(plane)
}

pub(super) fn post(
    shape: usize,
    x: f64,
    y: f64,
    radius: f64,
    bands: &[PostBand],
) -> Result<(), ColorMapError> {
    coordinate(shape, x)?;
    coordinate(shape, y)?;
    if !(radius > FLAT && radius <= MAX_COORDINATE) {
        return Err(ColorMapError::Value {
            shape,
            what: "radius, m",
            value: radius,
            must: "above 1e-6 and at most 1e6",
        });
    }
    if bands.is_empty() {
        return Err(ColorMapError::NoBands { shape });
    }
    let mut least_m = -MAX_COORDINATE;
    for (band, &PostBand { from, to, .. }) in bands.iter().enumerate() {
        coordinate(shape, from)?;
        coordinate(shape, to)?;
        if !(from >= least_m && to > from + FLAT) {
            return Err(ColorMapError::BandOrder { shape, band, from_m: from, to_m: to, least_m });
        }
        least_m = to;
    }
    Ok(())
}

/// Posts are sorted by their positions in plan, so no two may overlap there.
pub(super) fn posts_apart(prisms: &[Prism]) -> Result<(), ColorMapError> {
    for (i, a) in prisms.iter().enumerate() {
        for b in prisms[i + 1..].iter().filter(|b| b.shape != a.shape) {
            let distance_m = ((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y)).sqrt();
            let least_m = a.corner_radius + b.corner_radius;
            if distance_m < least_m {
                return Err(ColorMapError::PostsOverlap {
                    first: a.shape,
                    second: b.shape,
                    distance_m,
                    least_m,
                });
            }
        }
    }
    Ok(())
}

fn coordinate(shape: usize, value: f64) -> Result<(), ColorMapError> {
    if value.abs() <= MAX_COORDINATE {
        Ok(())
    } else {
        Err(ColorMapError::Value { shape, what: "coordinate, m", value, must: "within ±1e6" })
    }
}

/// The plane through the centroid with the polygon's vector area as normal: its length is twice the area, for any start vertex.
fn newell_plane(shape: usize, vertices: &[Vector3<f64>]) -> Result<Plane, ColorMapError> {
    let centroid = vertices.iter().sum::<Vector3<f64>>() / vertices.len() as f64;
    let doubled: Vector3<f64> = edges(vertices).map(|(a, b)| (a - centroid).cross(&(b - centroid))).sum();
    let area_m2 = 0.5 * doubled.norm();
    let perimeter_m: f64 = edges(vertices).map(|(a, b)| (b - a).norm()).sum();
    if area_m2 <= FLAT * perimeter_m {
        return Err(ColorMapError::Degenerate { shape, area_m2, perimeter_m });
    }
    let normal = doubled.normalize();
    Ok(Plane { normal, offset: normal.dot(&centroid) })
}

fn edges(vertices: &[Vector3<f64>]) -> impl Iterator<Item = (&Vector3<f64>, &Vector3<f64>)> {
    vertices.iter().zip(vertices.iter().cycle().skip(1))
}
