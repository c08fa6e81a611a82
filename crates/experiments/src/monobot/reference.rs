use nalgebra::{Matrix1, Vector1};
use serde::Deserialize;
use wayfix_estimation_traits::SensorModel;

/// Reference of the monobot's map to the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum WorldReference {
    /// None: the standard filter. [Andrade-Cetto 2005, Eq. 17, Fig. 4]
    None,
    /// A landmark at the origin with known position. [Andrade-Cetto 2005, Eqs. 20–22, Fig. 5]
    Anchor,
    /// A sensor that measures the robot's position. [Andrade-Cetto 2005, Eq. 23, Fig. 6]
    Camera,
}

/// A fixed sensor that measures where the robot is on its line; its standard deviation in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FixedPositionSensor(pub f64);

impl SensorModel for FixedPositionSensor {
    type State = Vector1<f64>;
    type Measurement = Vector1<f64>;

    fn expected(&self, robot: &Vector1<f64>) -> Vector1<f64> {
        *robot
    }
    fn jacobian(&self, _: &Vector1<f64>) -> Matrix1<f64> {
        Matrix1::identity()
    }
    fn noise(&self, _: &Vector1<f64>) -> Matrix1<f64> {
        Matrix1::new(self.0 * self.0)
    }
}
