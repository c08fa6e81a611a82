use nalgebra::{DMatrix, Matrix3, Matrix6, Rotation3, UnitQuaternion, Vector2, Vector3};
use wayfix_estimation_traits::{LieGroup, Pose2, Pose3};

use super::LineProblem;
use crate::{Between, Graph, RelativePosition, ResidualId, SmootherError, Variable, VariableId};

/// What pose graphs need of [`Pose2`] and [`Pose3`]. Vectors and matrices are those of space; the plane uses their first part.
pub trait RigidPose: LieGroup<Scalar = f64> + Variable + Copy {
    /// A landmark.
    type Point: Variable + Copy;
    /// 2 or 3.
    const N: usize;
    /// First words of the lines of a pose, a landmark, an edge, and an edge to a landmark.
    const TAGS: [&'static str; 4];
    /// Numbers that a line has for a pose.
    const N_NUMBERS: usize;
    /// Names of the tangent coordinates.
    const COORDINATES: &'static [&'static str];

    /// The pose of these numbers.
    ///
    /// # Errors
    /// [`LineProblem::NotARotation`]
    fn from_numbers(numbers: &[f64]) -> Result<Self, LineProblem>;
    /// The numbers of a line.
    fn numbers(&self) -> Vec<f64>;
    /// The landmark at these coordinates.
    fn point(coordinates: &[f64]) -> Self::Point;
    /// Coordinates of a landmark, metres.
    fn coordinates(point: &Self::Point) -> Vec<f64>;
    /// Rotation from the body to the world.
    fn rotation_part(&self) -> Matrix3<f64>;
    /// Position in the world, metres.
    fn translation_part(&self) -> Vector3<f64>;
    /// The pose with the rotation nearest to a matrix. [Umeyama 1991, Lemma]
    fn nearest(matrix: &Matrix3<f64>, translation: &Vector3<f64>) -> Self;
    /// The landmark at a point.
    fn point_at(position: &Vector3<f64>) -> Self::Point;
    /// Adds an edge between poses.
    ///
    /// # Errors
    /// As [`Graph::add`].
    fn add_edge(
        graph: &mut Graph,
        measured: &Self,
        ids: (VariableId<Self>, VariableId<Self>),
        information: &DMatrix<f64>,
    ) -> Result<ResidualId, SmootherError>;
    /// Adds an edge from a pose to a landmark.
    ///
    /// # Errors
    /// As [`Graph::add`].
    fn add_point_edge(
        graph: &mut Graph,
        measured: &Self::Point,
        ids: (VariableId<Self>, VariableId<Self::Point>),
        information: &DMatrix<f64>,
    ) -> Result<ResidualId, SmootherError>;
}

impl RigidPose for Pose2<f64> {
    type Point = Vector2<f64>;
    const N: usize = 2;
    const TAGS: [&'static str; 4] = ["VERTEX_SE2", "VERTEX_XY", "EDGE_SE2", "EDGE_SE2_XY"];
    const N_NUMBERS: usize = 3;
    const COORDINATES: &'static [&'static str] = &["x", "y", "θ"];

    fn from_numbers(numbers: &[f64]) -> Result<Self, LineProblem> {
        Ok(Self::new(numbers[0], numbers[1], numbers[2]))
    }
    fn numbers(&self) -> Vec<f64> {
        vec![self.x(), self.y(), self.heading()]
    }
    fn point(coordinates: &[f64]) -> Vector2<f64> {
        Vector2::new(coordinates[0], coordinates[1])
    }
    fn coordinates(point: &Vector2<f64>) -> Vec<f64> {
        vec![point.x, point.y]
    }
    fn rotation_part(&self) -> Matrix3<f64> {
        self.rotation_matrix().to_homogeneous()
    }
    fn translation_part(&self) -> Vector3<f64> {
        self.translation.push(0.0)
    }
    fn nearest(m: &Matrix3<f64>, translation: &Vector3<f64>) -> Self {
        Self::new(translation.x, translation.y, (m.m21 - m.m12).atan2(m.m11 + m.m22))
    }
    fn point_at(position: &Vector3<f64>) -> Vector2<f64> {
        position.xy()
    }
    fn add_edge(
        graph: &mut Graph,
        measured: &Self,
        ids: (VariableId<Self>, VariableId<Self>),
        information: &DMatrix<f64>,
    ) -> Result<ResidualId, SmootherError> {
        graph.add(Between::new(*measured), ids, Matrix3::from_column_slice(information.as_slice()))
    }
    fn add_point_edge(
        graph: &mut Graph,
        measured: &Vector2<f64>,
        ids: (VariableId<Self>, VariableId<Vector2<f64>>),
        information: &DMatrix<f64>,
    ) -> Result<ResidualId, SmootherError> {
        let information = nalgebra::Matrix2::from_column_slice(information.as_slice());
        graph.add(RelativePosition { measured: *measured }, ids, information)
    }
}

impl RigidPose for Pose3<f64> {
    type Point = Vector3<f64>;
    const N: usize = 3;
    const TAGS: [&'static str; 4] =
        ["VERTEX_SE3:QUAT", "VERTEX_TRACKXYZ", "EDGE_SE3:QUAT", "EDGE_SE3_TRACKXYZ"];
    const N_NUMBERS: usize = 7;
    const COORDINATES: &'static [&'static str] = &["x", "y", "z", "rx", "ry", "rz"];

    fn from_numbers(numbers: &[f64]) -> Result<Self, LineProblem> {
        let quaternion = nalgebra::Quaternion::new(numbers[6], numbers[3], numbers[4], numbers[5]);
        let norm = quaternion.norm();
        // Two written digits of a unit quaternion are within 1 %.
        if (norm - 1.0).abs() > 0.01 {
            return Err(LineProblem::NotARotation(norm));
        }
        let translation = Vector3::new(numbers[0], numbers[1], numbers[2]);
        // One that is of unit length up to rounding keeps its bits.
        let is_unit = (norm - 1.0).abs() <= 4.0 * f64::EPSILON;
        let rotation = if is_unit {
            UnitQuaternion::new_unchecked(quaternion)
        } else {
            UnitQuaternion::from_quaternion(quaternion)
        };
        Ok(Self { translation, rotation })
    }
    fn numbers(&self) -> Vec<f64> {
        let (t, q) = (self.translation, self.rotation);
        vec![t.x, t.y, t.z, q.i, q.j, q.k, q.w]
    }
    fn point(coordinates: &[f64]) -> Vector3<f64> {
        Vector3::new(coordinates[0], coordinates[1], coordinates[2])
    }
    fn coordinates(point: &Vector3<f64>) -> Vec<f64> {
        point.as_slice().to_vec()
    }
    fn rotation_part(&self) -> Matrix3<f64> {
        self.rotation.to_rotation_matrix().into_inner()
    }
    fn translation_part(&self) -> Vector3<f64> {
        self.translation
    }
    fn nearest(matrix: &Matrix3<f64>, translation: &Vector3<f64>) -> Self {
        let svd = matrix.svd(true, true);
        let rotation = match (svd.u, svd.v_t) {
            (Some(u), Some(v_t)) => {
                let mirror =
                    Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, (u * v_t).determinant().signum()));
                u * mirror * v_t
            }
            _ => Matrix3::identity(),
        };
        let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
        Self { translation: *translation, rotation }
    }
    fn point_at(position: &Vector3<f64>) -> Vector3<f64> {
        *position
    }
    fn add_edge(
        graph: &mut Graph,
        measured: &Self,
        ids: (VariableId<Self>, VariableId<Self>),
        information: &DMatrix<f64>,
    ) -> Result<ResidualId, SmootherError> {
        graph.add(Between::new(*measured), ids, Matrix6::from_column_slice(information.as_slice()))
    }
    fn add_point_edge(
        graph: &mut Graph,
        measured: &Vector3<f64>,
        ids: (VariableId<Self>, VariableId<Vector3<f64>>),
        information: &DMatrix<f64>,
    ) -> Result<ResidualId, SmootherError> {
        graph.add(
            RelativePosition { measured: *measured },
            ids,
            Matrix3::from_column_slice(information.as_slice()),
        )
    }
}
