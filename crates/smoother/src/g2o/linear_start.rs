use nalgebra::{DMatrix, Matrix3, Vector3};

use super::{PoseGraph, RigidPose};
use crate::{
    SmootherError,
    linear::{cholesky::Cholesky, pattern::Pattern},
};

/// Poses and landmarks of the linear start.
type Start<P> = (Vec<P>, Vec<<P as RigidPose>::Point>);

/// Rotations by least squares on $`R_j = R_i R_{ij}`$ without $`R^T R = I`$, projected to rotations; then positions on
/// $`t_j = t_i + R_i t_{ij}`$. Both are linear. [Martinec & Pajdla 2007; Carlone et al. 2015, III.B]
///
/// `None` if a part of the graph has no fixed pose.
pub(super) fn linear_start<P: RigidPose>(file: &PoseGraph<P>) -> Result<Option<Start<P>>, SmootherError> {
    let held = file.held();
    let mut block_of = vec![None; file.poses.len()];
    let free = (0..file.poses.len()).filter(|pose| !held.contains(&file.poses[*pose].0));
    let mut n_free = 0;
    for (block, pose) in free.enumerate() {
        block_of[pose] = Some(block);
        n_free = block + 1;
    }
    let pairs: Vec<_> =
        file.edges.iter().filter_map(|edge| block_of[edge.from].zip(block_of[edge.to])).collect();
    let pattern = Pattern::new(&vec![P::N; n_free], &pairs)?;
    let Some(rotations) = rotations(file, &block_of, &pattern)? else { return Ok(None) };
    let Some(positions) = positions(file, &block_of, &pattern.resized(1), &rotations)? else {
        return Ok(None);
    };
    let poses: Vec<P> = (0..file.poses.len())
        .map(|pose| match block_of[pose] {
            Some(_) => P::nearest(&rotations[pose], &positions[pose]),
            None => file.poses[pose].1,
        })
        .collect();
    let points = mean_positions(file, &poses, &held);
    Ok(Some((poses, points)))
}

/// Each row ρ of a rotation meets $`ρ_j = R_{ij}^T ρ_i`$.
fn rotations<P: RigidPose>(
    file: &PoseGraph<P>,
    block_of: &[Option<usize>],
    pattern: &Pattern,
) -> Result<Option<Vec<Matrix3<f64>>>, SmootherError> {
    let mut system = System::new(pattern, P::N);
    for edge in &file.edges {
        let weight = mean_information(&edge.information, P::N..edge.information.nrows());
        let m = edge.measured.rotation_part();
        let identity = Matrix3::identity();
        match (block_of[edge.from], block_of[edge.to]) {
            (Some(from), Some(to)) => {
                system.add(from, from, &identity, weight);
                system.add(to, to, &identity, weight);
                system.add(from, to, &m, -weight);
            }
            (None, Some(to)) => {
                system.add(to, to, &identity, weight);
                let rows = file.poses[edge.from].1.rotation_part().transpose();
                system.add_right(to, &(m.transpose() * rows), weight);
            }
            (Some(from), None) => {
                system.add(from, from, &identity, weight);
                system.add_right(from, &(m * file.poses[edge.to].1.rotation_part().transpose()), weight);
            }
            (None, None) => {}
        }
    }
    let Some(solution) = system.solve()? else { return Ok(None) };
    let rotation = |(pose, block): (usize, &Option<usize>)| match block {
        Some(block) => {
            let mut rows = Matrix3::identity();
            for i in 0..P::N {
                for k in 0..P::N {
                    rows[(i, k)] = solution[(pattern.offset(*block) + k, i)];
                }
            }
            P::nearest(&rows, &Vector3::zeros()).rotation_part()
        }
        None => file.poses[pose].1.rotation_part(),
    };
    Ok(Some(block_of.iter().enumerate().map(rotation).collect()))
}

fn positions<P: RigidPose>(
    file: &PoseGraph<P>,
    block_of: &[Option<usize>],
    pattern: &Pattern,
    rotations: &[Matrix3<f64>],
) -> Result<Option<Vec<Vector3<f64>>>, SmootherError> {
    let mut system = System::new(pattern, P::N);
    let one = Matrix3::identity();
    for edge in &file.edges {
        let weight = mean_information(&edge.information, 0..P::N);
        let step = rotations[edge.from] * edge.measured.translation_part();
        let ends = [(edge.from, 1.0), (edge.to, -1.0)];
        for (pose, sign) in ends {
            let Some(block) = block_of[pose] else { continue };
            let other = if pose == edge.from { edge.to } else { edge.from };
            system.add(block, block, &one, weight);
            let known = if block_of[other].is_none() {
                file.poses[other].1.translation_part()
            } else {
                Vector3::zeros()
            };
            let right = known - step * sign;
            system.add_right(
                block,
                &Matrix3::from_rows(&[right.transpose(), right.transpose(), right.transpose()]),
                weight,
            );
        }
        if let (Some(from), Some(to)) = (block_of[edge.from], block_of[edge.to]) {
            system.add(from, to, &one, -weight);
        }
    }
    let Some(solution) = system.solve()? else { return Ok(None) };
    let position = |(pose, block): (usize, &Option<usize>)| match block {
        Some(block) => {
            let mut position = Vector3::zeros();
            (0..P::N).for_each(|axis| position[axis] = solution[(pattern.offset(*block), axis)]);
            position
        }
        None => file.poses[pose].1.translation_part(),
    };
    Ok(Some(block_of.iter().enumerate().map(position).collect()))
}

/// Each landmark in the middle of where it was seen.
fn mean_positions<P: RigidPose>(
    file: &PoseGraph<P>,
    poses: &[P],
    held: &std::collections::BTreeSet<u64>,
) -> Vec<P::Point> {
    let mut sums = vec![(Vector3::zeros(), 0.0); file.points.len()];
    for edge in &file.point_edges {
        let mut seen = Vector3::zeros();
        seen.as_mut_slice()[..P::N].copy_from_slice(&P::coordinates(&edge.measured));
        let pose = &poses[edge.from];
        sums[edge.to].0 += pose.rotation_part() * seen + pose.translation_part();
        sums[edge.to].1 += 1.0;
    }
    let mut points = Vec::with_capacity(sums.len());
    for ((id, point), (sum, n)) in file.points.iter().zip(sums) {
        let stays = n == 0.0 || held.contains(id);
        points.push(if stays { *point } else { P::point_at(&(sum / n)) });
    }
    points
}

fn mean_information(information: &DMatrix<f64>, range: std::ops::Range<usize>) -> f64 {
    let n = range.len() as f64;
    range.map(|i| information[(i, i)]).sum::<f64>() / n
}

/// A symmetric system of small blocks with one right side for each axis.
struct System<'a> {
    pattern: &'a Pattern,
    entries: Vec<f64>,
    right: DMatrix<f64>,
}

impl<'a> System<'a> {
    fn new(pattern: &'a Pattern, n_sides: usize) -> Self {
        Self {
            pattern,
            entries: vec![0.0; pattern.n_entries()],
            right: DMatrix::zeros(pattern.n_rows(), n_sides),
        }
    }

    fn add(&mut self, a: usize, b: usize, block: &Matrix3<f64>, weight: f64) {
        let Some(address) = self.pattern.address(a, b) else { return };
        let n = self.pattern.dim(a);
        let (left, right) = (Matrix3::identity(), block * weight);
        let columns = |matrix: &Matrix3<f64>| {
            let mut columns = [0.0; 9];
            for k in 0..n {
                (0..n).for_each(|i| columns[k * n + i] = matrix[(i, k)]);
            }
            columns
        };
        address.add_product(
            &columns(&left)[..n * n],
            &columns(&right)[..n * n],
            (n, n, n),
            &mut self.entries,
        );
    }

    fn add_right(&mut self, block: usize, rows: &Matrix3<f64>, weight: f64) {
        let offset = self.pattern.offset(block);
        for i in 0..self.pattern.dim(block) {
            for side in 0..self.right.ncols() {
                self.right[(offset + i, side)] += weight * rows[(i, side)];
            }
        }
    }

    fn solve(mut self) -> Result<Option<DMatrix<f64>>, SmootherError> {
        let mut cholesky = Cholesky::new(self.pattern)?;
        if cholesky.factorize(&self.entries).is_err() {
            return Ok(None);
        }
        cholesky.solve_in_place(self.right.as_mut_slice())?;
        Ok(self.right.iter().all(|entry| entry.is_finite()).then_some(self.right))
    }
}
