use nalgebra::{Const, Matrix2, Vector2};
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_line_extract::WallSegment;

use super::WallLine;

/// A piece of a wall in one scan, in the sensor frame, with the covariance from its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallMeasurement {
    /// Its line.
    pub line: WallLine,
    /// Covariance of $`(ρ, α)`$.
    pub covariance: Matrix2<f64>,
    /// Its ends, metres.
    pub ends: [Vector2<f64>; 2],
}

impl From<&WallSegment> for WallMeasurement {
    fn from(segment: &WallSegment) -> Self {
        let found = segment.estimate.line;
        Self {
            line: WallLine::new(found.rho(), found.alpha()),
            covariance: segment.estimate.covariance,
            ends: [segment.start, segment.end],
        }
    }
}

impl WallMeasurement {
    /// The same piece in another frame, in which the sensor is at `sensor`.
    pub fn transformed(&self, sensor: &Pose2<f64>) -> Self {
        let turned = WallLine::new(0.0, self.line.alpha + sensor.heading());
        let lever = turned.along(&sensor.translation);
        let carry = Matrix2::new(1.0, lever, 0.0, 1.0);
        Self {
            line: WallLine { rho: self.line.rho + turned.normal().dot(&sensor.translation), ..turned },
            covariance: carry * self.covariance * carry.transpose(),
            ends: self.ends.map(|end| sensor.transform(&end)),
        }
    }

    /// Overlap of the two pieces along this one, m; negative for a gap between them.
    pub fn overlap(&self, other: &Self) -> f64 {
        let stretch = |piece: &Self| {
            let [a, b] = piece.ends.map(|end| self.line.along(&end));
            (a.min(b), a.max(b))
        };
        let (own, others) = (stretch(self), stretch(other));
        own.1.min(others.1) - own.0.max(others.0)
    }
}

impl Manifold for WallMeasurement {
    type Scalar = f64;
    type Dim = Const<2>;
    fn dim(&self) -> Const<2> {
        Const
    }
    fn retract(&self, delta: &Vector2<f64>) -> Self {
        Self { line: self.line.retract(delta), ..*self }
    }
    fn local(&self, other: &Self) -> Vector2<f64> {
        self.line.local(&other.line)
    }
}

#[cfg(test)]
mod tests {
    use approx::{abs_diff_eq, assert_abs_diff_eq};

    use super::*;

    #[test]
    fn carried_wall_has_the_covariance_of_its_numbers() {
        let seen = WallMeasurement {
            line: WallLine::new(2.0, 0.3),
            covariance: Matrix2::new(4e-4, 1e-5, 1e-5, 1e-4),
            ends: [-1.0, 1.0].map(|along| WallLine::new(2.0, 0.3).point_at(along)),
        };
        let sensor = Pose2::new(0.4, -1.2, 2.0);
        let carried = seen.transformed(&sensor);
        for end in carried.ends {
            assert_abs_diff_eq!(carried.line.normal().dot(&end), carried.line.rho, epsilon = 1e-12);
        }
        let numbers = |delta: &Vector2<f64>| seen.retract(delta).transformed(&sensor);
        let jacobian = wayfix_estimation_traits::numerical_jacobian(
            |delta: &Vector2<f64>| numbers(delta),
            &Vector2::zeros(),
        );
        let expected = jacobian * seen.covariance * jacobian.transpose();
        assert!(
            abs_diff_eq!(carried.covariance, expected, epsilon = 1e-9),
            "{}",
            carried.covariance - expected
        );
    }
}
