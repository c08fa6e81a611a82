use nalgebra::{Matrix3, Vector3};
use wayfix_color_map::PinholeCamera;
use wayfix_estimation_traits::Pose3;

/// One bundle of rays: the camera at one moment, each ray through the same spot of its pixel.
pub(super) struct View {
    pub(super) eye: Vector3<f64>,
    to_world: Matrix3<f64>,
    camera: PinholeCamera,
    /// Position of a ray in its pixel; the centre is (0.5, 0.5).
    pub(super) spot: (f64, f64),
}

/// $`a u + b v + c`$.
#[derive(Clone, Copy)]
pub(super) struct Affine {
    pub(super) a: f64,
    pub(super) b: f64,
    pub(super) c: f64,
}

impl View {
    pub(super) fn new(pose: &Pose3<f64>, camera: PinholeCamera, spot: (f64, f64)) -> Self {
        let to_world = pose.rotation.to_rotation_matrix().into_inner();
        Self { eye: pose.translation, to_world, camera, spot }
    }

    /// The ray through an image point, 1 long along the optical axis.
    pub(super) fn direction(&self, u: f64, v: f64) -> Vector3<f64> {
        self.to_world * self.camera.ray(u, v)
    }

    /// The ray of this bundle through a pixel.
    pub(super) fn ray(&self, column: usize, row: usize) -> Vector3<f64> {
        self.direction(column as f64 + self.spot.0, row as f64 + self.spot.1)
    }

    /// The product of [`direction`](Self::direction) and `covector`, as a function of the image point.
    pub(super) fn affine(&self, covector: &Vector3<f64>) -> Affine {
        let own = self.to_world.tr_mul(covector);
        let (y, z) = (own.y / self.camera.fx(), own.z / self.camera.fy());
        Affine { a: -y, b: -z, c: own.x + y * self.camera.cx() + z * self.camera.cy() }
    }

    /// The pixels of a row whose rays lie on the positive side of all planes (through the eye), given as affine functions.
    pub(super) fn columns(&self, row: usize, planes: &[Affine]) -> std::ops::Range<usize> {
        let v = row as f64 + self.spot.1;
        let (mut low, mut high) = (0.0_f64, f64::from(self.camera.width()));
        for plane in planes {
            let rest = plane.b * v + plane.c;
            if plane.a > 0.0 {
                low = low.max(-rest / plane.a - self.spot.0);
            } else if plane.a < 0.0 {
                high = high.min(-rest / plane.a - self.spot.0 + 1.0);
            } else if rest < 0.0 {
                return 0..0;
            }
        }
        // Casts saturate and take NaN to 0: the range stays within the row.
        let end = (high.floor() as usize).min(self.camera.width() as usize);
        low.ceil() as usize..end
    }

    pub(super) fn size(&self) -> (usize, usize) {
        (self.camera.width() as usize, self.camera.height() as usize)
    }
}

impl Affine {
    pub(super) fn at(self, u: f64, v: f64) -> f64 {
        self.a * u + self.b * v + self.c
    }
}
