use std::fmt;

use nalgebra::DMatrix;

use crate::{SmootherError, graph::structure::Structure};

/// A direction that no residual determines, named by one coordinate that moves along it.
#[derive(Clone, Debug, PartialEq)]
pub struct UnconstrainedDirection {
    /// Number of a variable that moves.
    pub variable: usize,
    /// Its tangent coordinate that moves, from 0.
    pub coordinate: usize,
    /// How many variables move with it, this one included.
    pub n_moving: usize,
}

impl fmt::Display for UnconstrainedDirection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "coordinate {} of variable {} (moves {})", self.coordinate, self.variable, self.n_moving)
    }
}

/// Share of the diagonal that makes a singular matrix one that can be factorized: far above rounding, far below what residuals determine.
const SHIFT: f64 = 1e-11;
/// Rayleigh quotients of free directions are below it: some hundred roundings of a scaled matrix.
const ROUNDING: f64 = 1e-13;
const N_ITERATIONS: usize = 5;
/// Most directions that are named.
const MOST_DIRECTIONS: usize = 128;
/// A coordinate moves with a direction if it moves this share of what moves most.
const MOVING: f64 = 1e-6;

/// Fails if the normal equations of `structure` leave directions free; otherwise they are factorized.
pub(crate) fn check(structure: &mut Structure) -> Result<(), SmootherError> {
    let diagonal = structure.equations.diagonal();
    let rounding = diagonal.len() as f64 * f64::EPSILON;
    let factored = structure.factorize(0.0).is_ok();
    // A pivot below its own rounding error may be a zero.
    let is_clear =
        || structure.cholesky.pivots().iter().zip(&diagonal).all(|(pivot, entry)| *pivot > rounding * entry);
    if factored && is_clear() {
        return Ok(());
    }
    let scale = structure.scale();
    let (free, complete) = free_directions(structure, &scale)?;
    if free.ncols() > 0 {
        return Err(SmootherError::Unconstrained { directions: names(structure, free), complete });
    }
    structure.factorize(0.0).map_err(|_| structure.ill_conditioned())
}

/// An orthonormal basis of the null space of $`D^{-1/2} H D^{-1/2}`$ by inverse subspace iteration, and whether it is whole.
fn free_directions(structure: &mut Structure, scale: &[f64]) -> Result<(DMatrix<f64>, bool), SmootherError> {
    let n = scale.len();
    structure.factorize(SHIFT).map_err(|_| structure.ill_conditioned())?;
    let root: Vec<f64> = scale.iter().map(|entry| entry.sqrt()).collect();
    let mut width = 8.min(n);
    loop {
        // Any start without symmetry will do.
        let mut basis =
            DMatrix::from_fn(n, width, |i, k| ((i * width + k) as f64 * 0.754_877_666 + 0.1).fract() - 0.5);
        for _ in 0..N_ITERATIONS {
            scale_rows(&mut basis, &root);
            structure.cholesky.solve_in_place(basis.as_mut_slice())?;
            scale_rows(&mut basis, &root);
            basis = basis.qr().q();
        }
        let mut image = basis.clone();
        for mut column in image.column_iter_mut() {
            let scaled: Vec<f64> = column.iter().zip(&root).map(|(entry, root)| entry / root).collect();
            let product = structure.equations.multiply(&scaled);
            column.iter_mut().zip(product.iter().zip(&root)).for_each(|(to, (from, root))| *to = from / root);
        }
        let small = basis.tr_mul(&image);
        let eigen = small.symmetric_part().symmetric_eigen();
        let free: Vec<usize> = (0..width).filter(|k| eigen.eigenvalues[*k] <= ROUNDING).collect();
        let complete = free.len() < width || width == n;
        if complete || width >= MOST_DIRECTIONS {
            return Ok((basis * eigen.eigenvectors.select_columns(&free), complete));
        }
        width = (2 * width).min(n);
    }
}

fn scale_rows(matrix: &mut DMatrix<f64>, factors: &[f64]) {
    for mut column in matrix.column_iter_mut() {
        column.iter_mut().zip(factors).for_each(|(entry, factor)| *entry *= factor);
    }
}

/// Gauss–Jordan elimination: each direction gets the first coordinate that moves along it and along no other.
fn names(structure: &Structure, mut free: DMatrix<f64>) -> Vec<UnconstrainedDirection> {
    let variables: Vec<(usize, usize)> = structure
        .offsets
        .iter()
        .enumerate()
        .filter_map(|(variable, offset)| Some((variable, (*offset)?)))
        .collect();
    let dim = |variable: usize| structure.dim(variable);
    let mut directions = Vec::new();
    let mut done = 0;
    for (variable, offset) in &variables {
        for coordinate in 0..dim(*variable) {
            let row = offset + coordinate;
            let left = free.columns(done, free.ncols() - done);
            let Some(best) =
                (0..left.ncols()).max_by(|a, b| left[(row, *a)].abs().total_cmp(&left[(row, *b)].abs()))
            else {
                continue;
            };
            if left[(row, best)].abs() <= 1e-3 * left.amax() {
                continue;
            }
            free.swap_columns(done, done + best);
            let pivot = free.column(done) / free[(row, done)];
            for other in (0..free.ncols()).filter(|other| *other != done) {
                let factor = free[(row, other)];
                free.column_mut(other).axpy(-factor, &pivot, 1.0);
            }
            free.set_column(done, &pivot);
            directions.push(UnconstrainedDirection { variable: *variable, coordinate, n_moving: 0 });
            done += 1;
        }
    }
    for (direction, column) in directions.iter_mut().zip(free.column_iter()) {
        let least = MOVING * column.amax();
        let moves = |(variable, offset): &&(usize, usize)| {
            column.rows(*offset, dim(*variable)).iter().any(|entry| entry.abs() > least)
        };
        direction.n_moving = variables.iter().filter(moves).count();
    }
    directions
}
