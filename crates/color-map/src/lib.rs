//! Maps of coloured surfaces, and their camera views.
//!
//! A [`ColorMap`] holds flat convex polygons and upright posts, each with one of the map's named colours. The crate computes which colour each pixel
//! of a camera shows, for a simulator that renders images and for a localizer that compares images with those expected at hypothetical
//! camera poses.
//! | ask | with | cost |
//! | --- | --- | --- |
//! | what does this ray hit | [`ColorMap::cast`] | every plane and post of the map |
//! | which pixels of a view have which colour | [`MapRenderer::spans`] | the map's corners and the image's spans, never its pixels |
//! | the same, without the pixels near an edge | [`MapRenderer::inner_spans`] | some words of bits a row and colour more |
//! | the same, as an image | [`MapRenderer::labels`] | the image |
//!
//! World: metres, z up, the carpet at z = 0. Camera: x forward along the optical axis, y left, z up (REP 103). Image: column $`u`$ to the
//! right, row $`v`$ down, pixel (i, j) covers [i, i+1) × [j, j+1) and sees what the ray through its centre sees.
//!
//! With the feature `serde`, maps are files (TOML, JSON): `colors = ["green", …]`, any number of `[[polygon]]` with `color` and `vertices`,
//! and of `[[post]]` with `x`, `y`, `radius` and `bands = [{ color, from, to }, …]`; `tests/field.toml` is one.
//!
//! ```
//! use std::sync::Arc;
//! use nalgebra::Vector3;
//! use wayfix_color_map::{PinholeCamera, ColorId, ColorMap, MapRenderer, ColoredShape};
//! use wayfix_estimation_traits::{LieGroup, Pose3};
//!
//! // A yellow board of 1 m x 0.6 m, two metres ahead of the camera.
//! let corner = |y, z| Vector3::new(2.0, y, z);
//! let board = ColoredShape::Polygon {
//!     color: ColorId(0),
//!     vertices: vec![corner(-0.5, -0.3), corner(0.5, -0.3), corner(0.5, 0.3), corner(-0.5, 0.3)],
//! };
//! let map = Arc::new(ColorMap::new(vec!["yellow".into()], vec![board])?);
//!
//! // At a focal length of 100 pixels a metre at 2 m is 100 / 2 pixels: the board has 50 x 30.
//! let camera = PinholeCamera::new(80, 60, 100.0, 100.0, 40.0, 30.0)?;
//! let mut renderer = MapRenderer::new(Arc::clone(&map), camera);
//! let labels = renderer.labels(&Pose3::identity())?;
//! assert_eq!(labels.count(ColorId(0)), 50 * 30);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod camera;
mod color;
mod error;
mod label_image;
mod map;
mod render;
mod shape;
mod span;
mod tree;

pub use camera::PinholeCamera;
pub use color::ColorId;
pub use error::{ColorMapError, RenderError};
pub use label_image::LabelImage;
pub use map::{ColorMap, MapExtent, RayHit};
pub use render::MapRenderer;
pub use shape::{ColoredShape, PostBand};
pub use span::PixelSpan;

pub use nalgebra;
