use nalgebra::Vector2;

use crate::random::{RandomStreamPurpose, RandomStreams, deviate};
use crate::{SimulationError, check, plane};

/// People around the robot: round, at new random positions in every scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct People {
    /// Mean number per scan, at most 100, including those hidden by walls. Default 0.
    pub mean: f64,
    /// Radius of a person, metres. Default 0.2.
    pub radius_m: f64,
    /// Minimum distance, m. Default 0.6.
    pub nearest_m: f64,
    /// Maximum distance, m. Default 5.
    pub farthest_m: f64,
}

impl Default for People {
    fn default() -> Self {
        Self { mean: 0.0, radius_m: 0.2, nearest_m: 0.6, farthest_m: 5.0 }
    }
}

impl People {
    pub(super) fn validate(&self) -> Result<(), SimulationError> {
        check::not_negative("mean number of people", self.mean)?;
        check::at_most("mean number of people", self.mean, 100.0, "at most 100")?;
        check::positive("radius of a person (m)", self.radius_m)?;
        let must = "finite and above a person's radius";
        check::above("least distance of people (m)", self.nearest_m, self.radius_m, must)?;
        let must = "finite and above their least distance";
        check::above("largest distance of people (m)", self.farthest_m, self.nearest_m, must)
    }

    /// The people of one scan, in the sensor's frame, in directions from `from` to `to` radians.
    pub(super) fn draw(&self, from: f64, to: f64, streams: &mut RandomStreams) -> Vec<Person> {
        let rng = streams.of(RandomStreamPurpose::People);
        (0..deviate::poisson(self.mean, rng))
            .map(|_| {
                let direction = plane::direction(deviate::uniform(from, to, rng));
                let distance = deviate::uniform(self.nearest_m, self.farthest_m, rng);
                Person { centre: direction * distance, radius_m: self.radius_m }
            })
            .collect()
    }
}

/// A person, seen from above.
pub(super) struct Person {
    centre: Vector2<f64>,
    radius_m: f64,
}

impl Person {
    /// Distance from the origin along the unit vector `direction` to the front.
    pub(super) fn distance(&self, direction: &Vector2<f64>) -> Option<f64> {
        let (along, beside) = (direction.dot(&self.centre), direction.perp(&self.centre));
        let half_chord = (self.radius_m * self.radius_m - beside * beside).sqrt();
        // NaN where the ray misses.
        Some(along - half_chord).filter(|distance| *distance >= 0.0)
    }
}
