use nalgebra::{Vector2, Vector3};
use rand::{Rng, RngExt};
use wayfix_color_map::PinholeCamera;

use crate::localizer::{buffer::BufferedFrame, estimate::PLACE_RADIUS};

/// The least slope of a ray to the ground: it ends at 1000 heights of the camera, which is far.
const MIN_SLOPE: f64 = 1e-3;

/// The axes along which the search moves a pose, each a cell (m, m, rad) long in the body frame: towards a `point`, about it, and a turn on the spot.
///
/// A step about a point leaves it where the camera sees it. A step along a side of the body moves all that is in view: a peak of the likelihood that is oblique to the
/// sides is not climbed. A point nearer than a place is treated as if at its radius.
pub(super) fn pose_axes(point: &Vector2<f64>, cell: &Vector3<f64>) -> [Vector3<f64>; 3] {
    let distance = point.norm().max(PLACE_RADIUS);
    let towards = point / distance;
    [
        towards.push(0.0) * cell.x,
        Vector3::new(towards.y, -towards.x, distance.recip()) * cell.y,
        Vector3::z() * cell.z,
    ]
}

/// Where the ray of a pixel, any with the same probability, meets the ground, in the body frame. A ray that does not ends far away.
pub(super) fn ground_in_view<R: Rng + ?Sized>(
    frame: &BufferedFrame,
    camera: &PinholeCamera,
    rng: &mut R,
) -> Vector2<f64> {
    let mut draw = |size: u32| f64::from(size) * rng.random::<f64>();
    let (column, row) = (draw(camera.width()), draw(camera.height()));
    let ray = frame.mount.rotation * camera.ray(column, row);
    let height = frame.mount.translation.z;
    frame.mount.translation.xy() + ray.xy() * (height / (-ray.z).max(MIN_SLOPE))
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use wayfix_estimation_traits::{Manifold, Pose2, Pose3};

    use super::*;
    use crate::{YuvImage, localizer::odometry::OdometryDelta};

    #[test]
    fn a_step_about_a_point_leaves_it_in_view() {
        let body = Pose2::new(1.0, -2.0, 0.7);
        let step = 1e-3;
        for point in [Vector2::new(2.0, 0.0), Vector2::new(0.5, -0.4), Vector2::new(-1.0, 3.0)] {
            let world = body.transform(&point);
            let [towards, about, _] = pose_axes(&point, &Vector3::new(0.3, 0.3, 0.1));
            // The step is along a tangent: the point moves by half of its square over the distance.
            let moved = body.retract(&(about * step)).inverse_transform(&world);
            assert!((moved - point).norm() < step * step, "{moved}");
            assert!((about.xy().norm() - 0.3).abs() < 1e-12);
            let nearer = body.retract(&(towards * step)).inverse_transform(&world);
            assert!((point.norm() - nearer.norm() - 0.3 * step).abs() < 1e-12);
        }
    }

    #[test]
    fn points_in_view_are_on_the_ground_or_far() {
        let camera = PinholeCamera::new(40, 30, 30.0, 30.0, 20.0, 15.0).unwrap();
        // Looks left and down by 0.2 rad: a part of the image is above the horizon.
        let turn = UnitQuaternion::from_euler_angles(0.0, 0.2, 1.5);
        let mount = Pose3 { translation: Vector3::new(0.1, 0.0, 0.5), rotation: turn };
        let image = YuvImage::new(40, 30, vec![[0; 3]; 1200]).unwrap();
        let frame = BufferedFrame { image, mount, odometry: OdometryDelta::default() };
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let points: Vec<_> = (0..1000).map(|_| ground_in_view(&frame, &camera, &mut rng)).collect();
        let seen = |point: &Vector2<f64>| {
            let at = turn.inverse() * (point.push(0.0) - mount.translation);
            camera.project(&at).is_some_and(|at| (0.0..40.0).contains(&at.x) && (0.0..30.0).contains(&at.y))
        };
        let (near, far): (Vec<_>, Vec<_>) = points.iter().partition(|point| point.norm() < 100.0);
        assert!(near.len() > 500 && far.len() > 50, "{} {}", near.len(), far.len());
        assert!(near.into_iter().all(seen) && far.into_iter().all(|point| point.y > 0.0));
    }
}
