//! The law suite of [`LandmarkModel`]: run it on a landmark model of your own.

use std::marker::PhantomData;

use nalgebra::{DefaultAllocator, linalg::Cholesky};
use wayfix_estimation_traits::{Jacobian, Manifold, SensorModel, TangentMatrix, UpdateAlloc, laws};

pub use wayfix_estimation_traits::laws::LawViolation;

use crate::{LandmarkDim, LandmarkModel, MeasurementDim, RobotDim, SlamAlloc};

/// The laws of [`LandmarkModel`], at every pair of a robot and a landmark in view.
///
/// 1. Both Jacobians are the derivatives of `expected`, and the noise is symmetric positive definite.
/// 2. `expected(robot, initialize(robot, z).landmark)` is `z`.
/// 3. The robot Jacobian of `initialize` is the derivative of its landmark, and its covariance is symmetric positive definite.
/// 4. A new landmark is no more certain than the measurement: $`H_m N H_m^T ⪰ R`$.
///
/// 5. Moving robot and landmark along a symmetry changes no measurement, and the motions of the robot by the symmetries are independent.
///
/// A model whose single measurement does not determine a landmark returns landmarks that are not finite; only the first law applies to it.
///
/// ```
/// use nalgebra::Vector2;
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_slam_ekf::{RangeBearingSensor, laws};
/// let robots = [Pose2::new(0.0, 0.0, 0.0), Pose2::new(1.0, -2.0, 3.1)];
/// laws::landmark_model(&RangeBearingSensor::default(), &robots, &[Vector2::new(4.0, 1.0)])?;
/// # Ok::<(), laws::LawViolation>(())
/// ```
///
/// # Errors
/// The first law that does not hold, and where.
pub fn landmark_model<M: LandmarkModel>(
    model: &M,
    robots: &[M::Robot],
    landmarks: &[M::Landmark],
) -> Result<(), LawViolation>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    for robot in robots {
        for landmark in landmarks {
            let at = |law: &str| {
                let place = format!("({law}, robot {robot:?}, landmark {landmark:?})");
                move |violation: LawViolation| LawViolation { case: place, ..violation }
            };
            let robot_sees = Sensor {
                expected: |robot: &M::Robot| model.expected(robot, landmark),
                jacobian: |robot: &M::Robot| model.robot_jacobian(robot, landmark),
                noise: |robot: &M::Robot| model.noise(&model.expected(robot, landmark)),
                spaces: PhantomData,
            };
            laws::sensor(&robot_sees, std::slice::from_ref(robot)).map_err(at("law 1, by the robot"))?;
            let landmark_is_seen = Sensor {
                expected: |landmark: &M::Landmark| model.expected(robot, landmark),
                jacobian: |landmark: &M::Landmark| model.landmark_jacobian(robot, landmark),
                noise: |landmark: &M::Landmark| model.noise(&model.expected(robot, landmark)),
                spaces: PhantomData,
            };
            laws::sensor(&landmark_is_seen, std::slice::from_ref(landmark))
                .map_err(at("law 1, by the landmark"))?;
            symmetry(model, robot, landmark).map_err(at("symmetry"))?;
            initialization(model, robot, &model.expected(robot, landmark)).map_err(at("initialize"))?;
        }
    }
    Ok(())
}

fn symmetry<M: LandmarkModel>(model: &M, robot: &M::Robot, landmark: &M::Landmark) -> Result<(), LawViolation>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    let (of_robot, of_landmark) = (model.robot_symmetry(robot), model.landmark_symmetry(landmark));
    let n_names = model.symmetries().len();
    let n_odd = of_robot.ncols().abs_diff(n_names) + of_landmark.ncols().abs_diff(n_names);
    within("one column for every name of a symmetry (law 5)", n_odd as f64, 0.0)?;
    if n_names == 0 {
        return Ok(());
    }
    let by_robot = model.robot_jacobian(robot, landmark);
    let by_landmark = model.landmark_jacobian(robot, landmark);
    let seen = &by_robot * &of_robot + &by_landmark * &of_landmark;
    let size = by_robot.amax() * of_robot.amax() + by_landmark.amax() * of_landmark.amax();
    within(
        "a symmetry changes no measurement (law 5)",
        seen.iter().fold(0.0, |m, x| x.abs().max(m)),
        1e-6 * size,
    )?; // numerical Jacobians
    let smallest = of_robot.singular_values().iter().copied().fold(f64::INFINITY, f64::min);
    within("every symmetry moves the robot (law 5)", if smallest > 1e-9 { 0.0 } else { 1.0 }, 0.0)
}

fn initialization<M: LandmarkModel>(
    model: &M,
    robot: &M::Robot,
    seen: &M::Measurement,
) -> Result<(), LawViolation>
where
    DefaultAllocator: SlamAlloc<RobotDim<M>, LandmarkDim<M>, MeasurementDim<M>>,
{
    let new = model.initialize(robot, seen);
    if !new.landmark.local(&new.landmark).iter().all(|entry| entry.is_finite()) {
        return Ok(());
    }
    let missed = seen.local(&model.expected(robot, &new.landmark)).norm();
    let size = 1.0 + new.robot_jacobian.amax();
    within("expected(initialize(z)) = z (law 2)", missed, 1e-12 * size)?; // some thousand roundings

    // The new landmark as a function of the robot, with the landmark's covariance for its noise.
    let placed = Sensor {
        expected: |robot: &M::Robot| model.initialize(robot, seen).landmark,
        jacobian: |robot: &M::Robot| model.initialize(robot, seen).robot_jacobian,
        noise: |robot: &M::Robot| model.initialize(robot, seen).covariance,
        spaces: PhantomData::<(M::Robot, M::Landmark)>,
    };
    laws::sensor(&placed, std::slice::from_ref(robot))?;

    let jacobian = model.landmark_jacobian(robot, &new.landmark);
    let seen_again = &jacobian * &new.covariance * jacobian.transpose();
    let is_honest = Cholesky::new(seen_again - model.noise(seen) * (1.0 - 1e-6)).is_some(); // equal up to rounding
    within(
        "a new landmark is no more certain than the measurement (law 4)",
        if is_honest { 0.0 } else { f64::INFINITY },
        0.0,
    )
}

fn within(law: &'static str, error: f64, tolerance: f64) -> Result<(), LawViolation> {
    laws::within(law, error, tolerance, String::new)
}

/// A sensor whose three functions are closures.
struct Sensor<X, Z, E, J, N> {
    expected: E,
    jacobian: J,
    noise: N,
    spaces: PhantomData<(X, Z)>,
}

impl<X, Z, E, J, N> SensorModel for Sensor<X, Z, E, J, N>
where
    X: Manifold<Scalar = f64>,
    Z: Manifold<Scalar = f64>,
    E: Fn(&X) -> Z,
    J: Fn(&X) -> Jacobian<Z, X>,
    N: Fn(&X) -> TangentMatrix<Z>,
    DefaultAllocator: UpdateAlloc<X::Dim, Z::Dim>,
{
    type State = X;
    type Measurement = Z;

    fn expected(&self, state: &X) -> Z {
        (self.expected)(state)
    }
    fn jacobian(&self, state: &X) -> Jacobian<Z, X> {
        (self.jacobian)(state)
    }
    fn noise(&self, state: &X) -> TangentMatrix<Z> {
        (self.noise)(state)
    }
}
