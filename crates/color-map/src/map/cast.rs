use nalgebra::Vector3;

use super::{ColorMap, PLANE_TOLERANCE_M};
use crate::ColorId;

/// First intersection of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// Colour of the surface.
    pub color: ColorId,
    /// Metres from the ray's origin.
    pub distance: f64,
    /// Place of the shape in [`ColorMap::shapes`].
    pub shape: usize,
}

impl ColorMap {
    /// First intersection of the ray from `origin` along `direction` (of any nonzero length).
    ///
    /// This is the reference definition of visibility; [`MapRenderer`](crate::MapRenderer) computes the same for a whole image. A polygon whose plane is
    /// within 1e-9 m of the origin is edge-on and invisible, and so is a post from inside. Returns `None` if a number is not finite.
    /// ```
    /// use nalgebra::Vector3;
    /// use wayfix_color_map::{PostBand, ColorId, ColorMap, ColoredShape};
    ///
    /// let (pink, cyan) = (ColorId(0), ColorId(1));
    /// let bands = vec![PostBand { color: pink, from: 0.0, to: 0.2 }, PostBand { color: cyan, from: 0.2, to: 0.4 }];
    /// let beacon = ColoredShape::Post { x: 3.0, y: 0.0, radius: 0.1, bands };
    /// let map = ColorMap::new(vec!["pink".into(), "cyan".into()], vec![beacon])?;
    ///
    /// let hit = map.cast(&Vector3::new(0.0, 0.0, 0.3), &Vector3::x()).unwrap();
    /// assert_eq!(hit.color, cyan);
    /// assert!((hit.distance - 2.9).abs() < 1e-3); // the prism that stands for the post is 0.65 mm wider here
    /// assert_eq!(map.cast(&Vector3::new(0.0, 0.0, 0.5), &Vector3::x()), None);
    /// # Ok::<(), wayfix_color_map::ColorMapError>(())
    /// ```
    pub fn cast(&self, origin: &Vector3<f64>, direction: &Vector3<f64>) -> Option<RayHit> {
        let mut nearest = f64::INFINITY;
        let mut met = None;
        for layer in &self.layers {
            let height = layer.plane.distance(origin);
            let at = -height / layer.plane.normal.dot(direction);
            // Written so that a NaN skips the polygon.
            if !(height.abs() > PLANE_TOLERANCE_M && at > 0.0 && at < nearest) {
                continue;
            }
            let point = origin + direction * at;
            let on_top = layer.decals.iter().rev().find(|d| d.contains(&layer.plane.normal, &point));
            if let Some(decal) = on_top {
                nearest = at;
                met = Some((decal.color, decal.shape));
            }
        }
        for prism in &self.prisms {
            match prism.enter(origin, direction) {
                Some(at) if at < nearest => {
                    nearest = at;
                    met = Some((prism.color, prism.shape));
                }
                _ => {}
            }
        }
        met.map(|(color, shape)| RayHit { color, distance: nearest * direction.norm(), shape })
    }
}
