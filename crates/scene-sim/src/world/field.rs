use nalgebra::Vector2;
use rand::Rng;

use super::{FloorPlan, layout::MOST_LANDMARKS};
use crate::random::deviate::uniform;
use crate::{SimulationError, check};

/// Draws per landmark before the square counts as full.
const ATTEMPTS: usize = 1000;

/// Landmarks uniformly in a square about the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniformLandmarkField {
    /// Number of landmarks.
    pub n_landmarks: usize,
    /// Half the side of the square, metres.
    pub half_width_m: f64,
    /// The least distance between two landmarks, metres; 0 for none.
    pub separation_m: f64,
}

impl UniformLandmarkField {
    /// Places the landmarks.
    ///
    /// # Errors
    /// Returns an error if a number is out of range or the landmarks do not find room.
    ///
    /// ```
    /// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
    /// use wayfix_scene_sim::world::UniformLandmarkField;
    /// let field = UniformLandmarkField { n_landmarks: 20, half_width_m: 5.0, separation_m: 1.0 };
    /// let plan = field.plan(&mut ChaCha8Rng::seed_from_u64(1))?;
    /// assert_eq!(plan.landmarks.len(), 20);
    /// # Ok::<(), wayfix_scene_sim::SimulationError>(())
    /// ```
    pub fn plan<R: Rng + ?Sized>(&self, rng: &mut R) -> Result<FloorPlan, SimulationError> {
        check::count("landmarks", self.n_landmarks, MOST_LANDMARKS)?;
        check::positive("half width of the field (m)", self.half_width_m)?;
        check::not_negative("separation of the landmarks (m)", self.separation_m)?;
        let mut points: Vec<Vector2<f64>> = Vec::with_capacity(self.n_landmarks);
        while points.len() < self.n_landmarks {
            let fresh = (0..ATTEMPTS).map(|_| self.draw(rng)).find(|fresh| self.is_free(fresh, &points));
            match fresh {
                Some(fresh) => points.push(fresh),
                None => {
                    let (placed, wanted) = (points.len(), self.n_landmarks);
                    return Err(SimulationError::NoRoom { what: "landmarks", placed, wanted });
                }
            }
        }
        Ok(FloorPlan::numbered(points, Vec::new()))
    }

    fn draw<R: Rng + ?Sized>(&self, rng: &mut R) -> Vector2<f64> {
        let mut coordinate = || uniform(-self.half_width_m, self.half_width_m, rng);
        Vector2::new(coordinate(), coordinate())
    }

    fn is_free(&self, fresh: &Vector2<f64>, points: &[Vector2<f64>]) -> bool {
        self.separation_m == 0.0
            || points.iter().all(|p| (p - fresh).norm_squared() >= self.separation_m * self.separation_m)
    }
}
