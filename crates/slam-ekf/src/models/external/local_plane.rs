use nalgebra::{Vector2, Vector3};

/// The plane that touches the WGS 84 ellipsoid at a datum: x east, y north, metres.
///
/// ```
/// use wayfix_slam_ekf::LocalPlane;
/// let plane = LocalPlane::new(48.0, 11.0).expect("on earth");
/// let north = plane.position(48.001, 11.0);
/// assert!(north.x.abs() < 1e-6 && (north.y - 111.190).abs() < 1e-3); // a thousandth of a degree of the meridian
/// assert!(LocalPlane::new(91.0, 0.0).is_none());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalPlane {
    latitude: f64,
    longitude: f64,
}

/// Semi-major axis, m, and flattening of WGS 84.
const SEMI_MAJOR_AXIS: f64 = 6_378_137.0;
const FLATTENING: f64 = 1.0 / 298.257_223_563;

impl LocalPlane {
    /// The plane at a latitude and longitude in degrees; `None` if they are not on earth.
    pub fn new(latitude: f64, longitude: f64) -> Option<Self> {
        let on_earth = latitude.abs() <= 90.0 && longitude.abs() <= 360.0;
        on_earth.then(|| Self { latitude: latitude.to_radians(), longitude: longitude.to_radians() })
    }

    /// The position of a point of the ellipsoid: latitude and longitude in degrees.
    pub fn position(&self, latitude: f64, longitude: f64) -> Vector2<f64> {
        let chord = geocentric(latitude.to_radians(), longitude.to_radians())
            - geocentric(self.latitude, self.longitude);
        let ((sin_lat, cos_lat), (sin_lon, cos_lon)) = (self.latitude.sin_cos(), self.longitude.sin_cos());
        let east = Vector3::new(-sin_lon, cos_lon, 0.0);
        let north = Vector3::new(-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat);
        Vector2::new(east.dot(&chord), north.dot(&chord))
    }
}

/// Earth-centred, earth-fixed coordinates, m.
fn geocentric(latitude: f64, longitude: f64) -> Vector3<f64> {
    let eccentricity_squared = FLATTENING * (2.0 - FLATTENING);
    let ((sin_lat, cos_lat), (sin_lon, cos_lon)) = (latitude.sin_cos(), longitude.sin_cos());
    let normal = SEMI_MAJOR_AXIS / (1.0 - eccentricity_squared * sin_lat * sin_lat).sqrt();
    Vector3::new(
        normal * cos_lat * cos_lon,
        normal * cos_lat * sin_lon,
        normal * (1.0 - eccentricity_squared) * sin_lat,
    )
}
