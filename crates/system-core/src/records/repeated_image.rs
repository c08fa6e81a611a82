use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_sensor_log::EncodedImage;

/// Finds images of a camera that hangs: each equals the one before, although the robot has moved.
///
/// ```
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_sensor_log::{EncodedImage, ImageFileFormat};
/// use wayfix_system_core::RepeatedImageCheck;
/// let image = EncodedImage { format: ImageFileFormat::Png, bytes: vec![1, 2, 3].into() };
/// let mut check = RepeatedImageCheck::default();
/// assert!(check.check(&image, 300.0).is_ok() && check.check(&image, 300.0).is_ok()); // the robot stands
/// check.move_by(&Pose2::new(0.0, 0.0, 0.1));
/// assert!(check.check(&image, 300.0).is_err()); // 30 pixels
/// ```
#[derive(Clone, Debug, Default)]
pub struct RepeatedImageCheck {
    last: Option<LastImage>,
}

/// An image that differs from the one before, and the motion since.
#[derive(Clone, Debug)]
struct LastImage {
    image: EncodedImage,
    moved: Pose2<f64>,
}

impl RepeatedImageCheck {
    /// Adds a motion by odometry.
    pub fn move_by(&mut self, increment: &Pose2<f64>) {
        if let Some(LastImage { moved, .. }) = &mut self.last {
            *moved = moved.compose(increment);
        }
    }

    /// Takes an image of a camera with this number of pixels per radian.
    ///
    /// # Errors
    /// Returns the reason if the image repeats the last one although the robot has turned by more than a pixel, or moved as far as turns a view at 1 m so.
    pub fn check(&mut self, image: &EncodedImage, pixels_per_radian: f64) -> Result<(), String> {
        let Some(LastImage { moved, .. }) = self.last.as_ref().filter(|last| last.image == *image) else {
            self.last = Some(LastImage { image: image.clone(), moved: Pose2::identity() });
            return Ok(());
        };
        let shift = (moved.translation.norm() + moved.heading().abs()) * pixels_per_radian;
        if shift <= 1.0 {
            return Ok(());
        }
        Err(format!(
            "the image repeats the one before, although odometry has moved it by some {shift:.0} pixels: the camera hangs, or the log repeats its images"
        ))
    }
}
