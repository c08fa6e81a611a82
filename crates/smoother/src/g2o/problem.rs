use nalgebra::DMatrix;

use super::{G2oError, LineProblem, PoseGraph, RigidPose, linear_start};
use crate::{Graph, ResidualId, SmootherError, VariableId, information};

/// What to do with information matrices that have negative eigenvalues.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Repair {
    /// Refuse them, with their number.
    #[default]
    Refuse,
    /// Set negative eigenvalues to 0: the nearest matrix without them. [Higham 1988, Theorem 2.1]
    ClipEigenvalues,
}

/// A pose graph as a least squares problem.
pub struct Problem<P: RigidPose> {
    /// Variables in the order of the pose graph, poses before landmarks.
    pub graph: Graph,
    /// Variables of the poses.
    pub poses: Vec<VariableId<P>>,
    /// Variables of the landmarks.
    pub points: Vec<VariableId<P::Point>>,
    /// Residuals of the edges between poses, in the order of the pose graph.
    pub edges: Vec<ResidualId>,
    /// How many information matrices were repaired.
    pub n_repaired: usize,
}

impl<P: RigidPose> PoseGraph<P> {
    /// The least squares problem at the present poses. The cost is $`\sum e^T Ω e`$ with the logarithm of the whole group.
    ///
    /// # Errors
    /// [`G2oError::Indefinite`], [`G2oError::Line`] for numbers that overflow, and as [`Graph::add`].
    pub fn problem(&self, repair: Repair) -> Result<Problem<P>, G2oError> {
        let mut graph = Graph::new();
        let poses: Vec<_> = self.poses.iter().map(|(_, pose)| graph.add_variable(*pose)).collect();
        let points: Vec<_> = self.points.iter().map(|(_, point)| graph.add_variable(*point)).collect();
        let held = self.held();
        for ((id, _), variable) in self.poses.iter().zip(&poses) {
            if held.contains(id) {
                graph.fix(*variable)?;
            }
        }
        for ((id, _), variable) in self.points.iter().zip(&points) {
            if held.contains(id) {
                graph.fix(*variable)?;
            }
        }
        let mut check = Check { repair, n_indefinite: 0, first_line: 0, smallest: 0.0 };
        let mut edges = Vec::with_capacity(self.edges.len());
        for edge in &self.edges {
            let Some(information) = check.usable(&edge.information, edge.line)? else { continue };
            let ids = (poses[edge.from], poses[edge.to]);
            let added = P::add_edge(&mut graph, &edge.measured, ids, &information);
            edges.push(added.map_err(|error| in_line(error, edge.line))?);
        }
        for edge in &self.point_edges {
            let Some(information) = check.usable(&edge.information, edge.line)? else { continue };
            let ids = (poses[edge.from], points[edge.to]);
            let added = P::add_point_edge(&mut graph, &edge.measured, ids, &information);
            added.map_err(|error| in_line(error, edge.line))?;
        }
        if repair == Repair::Refuse && check.n_indefinite > 0 {
            let total = self.edges.len() + self.point_edges.len();
            let Check { n_indefinite: count, first_line, smallest, .. } = check;
            return Err(G2oError::Indefinite { count, total, first_line, smallest });
        }
        Ok(Problem { graph, poses, points, edges, n_repaired: check.n_indefinite })
    }
}

impl<P: RigidPose> Problem<P> {
    /// Moves all that is not fixed to the linear start: rotations by chordal relaxation, then positions. [Carlone et al. 2015, III]
    ///
    /// Returns whether there is one: a part without a fixed pose has none, and stays.
    ///
    /// # Errors
    /// [`SmootherError::OutOfMemory`]
    pub fn start_linearly(&mut self, file: &PoseGraph<P>) -> Result<bool, SmootherError> {
        let Some((poses, points)) = linear_start::linear_start(file)? else { return Ok(false) };
        for (id, pose) in self.poses.iter().zip(poses) {
            self.graph.set_value(*id, pose)?;
        }
        for (id, point) in self.points.iter().zip(points) {
            self.graph.set_value(*id, point)?;
        }
        Ok(true)
    }

    /// Writes the values into the pose graph.
    ///
    /// # Errors
    /// [`SmootherError::UnknownId`] if it is not the one of this problem.
    pub fn store(&self, file: &mut PoseGraph<P>) -> Result<(), SmootherError> {
        for (id, pose) in self.poses.iter().zip(&mut file.poses) {
            pose.1 = *self.graph.value(*id)?;
        }
        for (id, point) in self.points.iter().zip(&mut file.points) {
            point.1 = *self.graph.value(*id)?;
        }
        Ok(())
    }

    /// The error with names of vertices and coordinates, where it names variables.
    pub fn named(&self, file: &PoseGraph<P>, error: SmootherError) -> G2oError {
        let more = |n: usize| if n > 6 { format!(" and {} more", n - 6) } else { String::new() };
        match error {
            SmootherError::WithoutResidual { variables } => {
                let ids: Vec<_> =
                    variables.iter().take(6).map(|index| file.vertex(*index).to_string()).collect();
                let (n, ids) = (variables.len(), ids.join(", "));
                let what = if n == 1 { "vertex" } else { "vertices" };
                G2oError::Undetermined(format!("no edge leads to {n} {what}: {ids}{}", more(n)))
            }
            SmootherError::Unconstrained { directions, complete } => {
                let name = |direction: &crate::UnconstrainedDirection| {
                    let coordinate = P::COORDINATES[direction.coordinate];
                    let (id, n) = (file.vertex(direction.variable), direction.n_moving);
                    // While some directions are unknown, the others are mixtures of all, and their counts mean nothing.
                    if complete {
                        format!("{coordinate} of vertex {id} ({n} vertices move with it)")
                    } else {
                        format!("{coordinate} of vertex {id}")
                    }
                };
                let names: Vec<_> = directions.iter().take(6).map(name).collect();
                let (n, names) = (directions.len(), names.join(", "));
                let least = if complete { "" } else { "at least " };
                let what = if n == 1 { "direction" } else { "directions" };
                G2oError::Undetermined(format!("no edge determines {least}{n} {what}: {names}{}", more(n)))
            }
            SmootherError::NotFinite { residual: Some(residual), .. } => {
                let lines = file.edges.iter().map(|edge| edge.line);
                let mut lines = lines.chain(file.point_edges.iter().map(|edge| edge.line));
                lines.nth(residual).map_or(G2oError::Smoother(error.clone()), |line| in_line(error, line))
            }
            other => G2oError::Smoother(other),
        }
    }
}

/// An error of the numbers of a line, with its number.
fn in_line(error: SmootherError, line: usize) -> G2oError {
    match error {
        SmootherError::NotFinite { what, .. } => {
            G2oError::Line { line, problem: LineProblem::NotFinite(what) }
        }
        other => G2oError::Smoother(other),
    }
}

struct Check {
    repair: Repair,
    n_indefinite: usize,
    first_line: usize,
    smallest: f64,
}

impl Check {
    /// The matrix, repaired if wanted; `None` if it is indefinite, which is counted.
    fn usable(&mut self, matrix: &DMatrix<f64>, line: usize) -> Result<Option<DMatrix<f64>>, G2oError> {
        match information::check(matrix, line) {
            Ok(()) => return Ok(Some(matrix.clone())),
            Err(SmootherError::IndefiniteInformation { smallest, .. }) => {
                self.smallest = self.smallest.min(smallest);
            }
            Err(other) => return Err(in_line(other, line)),
        }
        if self.n_indefinite == 0 {
            self.first_line = line;
        }
        self.n_indefinite += 1;
        Ok((self.repair == Repair::ClipEigenvalues).then(|| information::clipped(matrix)))
    }
}
