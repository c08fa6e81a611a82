use crate::discrete::chunks::map_chunks;
use crate::error::{check_size, checked};
use crate::{CondensationError, LatticeAxis, StateLattice, TransitionModel};

/// Disturbances that spread belief over the neighbours, as a separable Gaussian. [Kasprzak & Szynkiewicz, Eq. 5]
///
/// ```math
/// p'(s') = \sum_s \frac{k(s' - s)}{\sum_{s''} k(s'' - s)}\, \hat p(s), \qquad k(δ) = \prod_i e^{-δ_i^2 / 2 σ_i^2}
/// ```
///
/// The paper's factor $`1 / 2πσ`$ makes the kernel one only in the limit, and at a border it loses mass; here what leaves each state is
/// divided by what stays inside, so belief stays a distribution. Along a cyclic axis it wraps.
///
/// ```
/// use wayfix_condensation::{DiffusionKernel, PositionGrid, TransitionModel};
/// let kernel = DiffusionKernel::gaussian(&PositionGrid::new(3, 1)?, &[0.5, 0.5])?;
/// let mut spread = [0.0; 3];
/// kernel.predict(&[1.0, 0.0, 0.0], &mut spread);
/// assert!((spread.iter().sum::<f64>() - 1.0).abs() < 1e-15 && spread[0] > spread[1] && spread[1] > spread[2]);
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct DiffusionKernel {
    passes: Vec<Pass>,
    n_states: usize,
}

/// The kernel along one axis.
#[derive(Clone, Debug, PartialEq)]
struct Pass {
    axis: LatticeAxis,
    stride: usize,          // between neighbours of this axis
    weights: Vec<f64>,      // of distances 0, 1, … up to the radius
    inverse_mass: Vec<f64>, // of what stays inside, by position
}

impl DiffusionKernel {
    /// A Gaussian of `sigmas` states along each axis, cut off at four of them. Zero leaves an axis alone.
    ///
    /// # Errors
    /// [`CondensationError::Dimension`] when there is not one sigma an axis, [`CondensationError::Parameter`] when one is negative, NaN or
    /// infinite.
    pub fn gaussian(space: &impl StateLattice, sigmas: &[f64]) -> Result<Self, CondensationError> {
        let axes = space.axes();
        check_size("list of sigmas", axes.len(), sigmas.len())?;
        let mut passes = Vec::new();
        let mut stride = 1;
        for (&axis, &sigma) in axes.iter().zip(sigmas).rev() {
            checked(
                "sigma of diffusion",
                sigma,
                sigma.is_finite() && sigma >= 0.0,
                "finite and not negative",
            )?;
            if sigma > 0.0 && axis.len > 1 {
                passes.push(Pass::new(axis, stride, sigma));
            }
            stride *= axis.len;
        }
        Ok(Self { passes, n_states: space.n_states() })
    }

    /// Share of the belief of `from` that goes to `to`, along a line of states.
    pub(crate) fn share(&self, from: usize, to: usize) -> f64 {
        match self.passes.as_slice() {
            [line] => {
                line.weights.get(from.abs_diff(to)).map_or(0.0, |weight| line.inverse_mass[from] * weight)
            }
            _ => f64::from(u8::from(from == to)),
        }
    }
}

impl TransitionModel for DiffusionKernel {
    fn n_states(&self) -> usize {
        self.n_states
    }

    fn predict(&self, belief: &[f64], predicted: &mut [f64]) {
        let Some((first, further)) = self.passes.split_first() else {
            return predicted.copy_from_slice(belief);
        };
        first.apply(belief, predicted);
        let mut source = if further.is_empty() { Vec::new() } else { vec![0.0; predicted.len()] };
        for pass in further {
            source.copy_from_slice(predicted);
            pass.apply(&source, predicted);
        }
    }
}

impl Pass {
    fn new(axis: LatticeAxis, stride: usize, sigma: f64) -> Self {
        // On a ring two ways lead to a state once the kernel is wider than half of it: then it is cut there.
        let reach = if axis.is_cyclic { (axis.len - 1) / 2 } else { axis.len - 1 };
        let radius = ((4.0 * sigma).ceil() as usize).min(reach);
        let weights: Vec<f64> = (0..=radius).map(|d| (-0.5 * (d as f64 / sigma).powi(2)).exp()).collect();
        let mass = |at: usize| -> f64 {
            let side = |inside: &dyn Fn(usize) -> bool| -> f64 {
                (1..=radius).filter(|&d| axis.is_cyclic || inside(d)).map(|d| weights[d]).sum()
            };
            weights[0] + side(&|d| d <= at) + side(&|d| at + d < axis.len)
        };
        let inverse_mass = (0..axis.len).map(|at| 1.0 / mass(at)).collect();
        Self { axis, stride, weights, inverse_mass }
    }

    /// Every line of neighbours along the axis, `stride` lines side by side.
    fn apply(&self, source: &[f64], target: &mut [f64]) {
        let line = self.stride; // contiguous states that share a position on this axis
        let lines_a_chunk = (crate::discrete::chunks::CHUNK / line).max(1);
        if line == 1 {
            // Contiguous: whole lines a chunk.
            let len = self.axis.len;
            map_chunks(target, len * (lines_a_chunk / len).max(1), |first, chunk| {
                for (i, out) in chunk.chunks_mut(len).enumerate() {
                    let start = first + i * len;
                    self.convolve_contiguous(&source[start..start + len], out);
                }
            });
        } else {
            map_chunks(target, line * lines_a_chunk, |first, chunk| {
                for (i, out) in chunk.chunks_mut(line).enumerate() {
                    self.gather(source, first / line + i, out);
                }
            });
        }
    }

    /// One line at once: a state's neighbours lie side by side in memory.
    fn convolve_contiguous(&self, source: &[f64], target: &mut [f64]) {
        target.fill(0.0);
        for (at, (&mass, &inverse)) in source.iter().zip(&self.inverse_mass).enumerate() {
            target[at] += mass * inverse * self.weights[0];
        }
        for (d, &weight) in self.weights.iter().enumerate().skip(1) {
            let n = source.len() - d;
            // From the left to the right neighbour, and back.
            for i in 0..n {
                target[i + d] += source[i] * self.inverse_mass[i] * weight;
            }
            for i in 0..n {
                target[i] += source[i + d] * self.inverse_mass[i + d] * weight;
            }
            if self.axis.is_cyclic {
                for i in 0..d {
                    target[i] += source[n + i] * self.inverse_mass[n + i] * weight;
                    target[n + i] += source[i] * self.inverse_mass[i] * weight;
                }
            }
        }
    }

    /// All states of line number `index` at once: their neighbours are whole lines.
    fn gather(&self, source: &[f64], index: usize, target: &mut [f64]) {
        let (line, len) = (self.stride, self.axis.len);
        let (at, first) = (index % len, index - index % len);
        target.fill(0.0);
        let mut add = |position: usize, weight: f64| {
            let factor = weight * self.inverse_mass[position];
            let start = (first + position) * line;
            for (to, from) in target.iter_mut().zip(&source[start..start + line]) {
                *to += factor * from;
            }
        };
        add(at, self.weights[0]);
        for (d, &weight) in self.weights.iter().enumerate().skip(1) {
            if self.axis.is_cyclic || d <= at {
                add((at + len - d) % len, weight);
            }
            if self.axis.is_cyclic || at + d < len {
                add((at + d) % len, weight);
            }
        }
    }
}
