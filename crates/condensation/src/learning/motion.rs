use crate::error::check_state;
use crate::{
    CondensationError, DiffusionKernel, DiscreteStateSpace, GridMove, PositionGrid, SparseTransition,
    TransitionCounts,
};

/// Weight of the commanded move beside the logged ones, in moves: the prior of a state that was never left.
const PRIOR_MOVES: f64 = 1.0;
/// The smallest width of diffusion that differs from none: the next state gets $`e^{-8}`$.
const MIN_SIGMA: f64 = 0.25;
/// Ratio of neighbouring widths that are compared: a quarter of an octave.
const RATIO: f64 = 1.189_207_115_002_721;

/// One move of a logged drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoggedMove {
    /// State before.
    pub from: usize,
    /// Commanded action.
    pub action: GridMove,
    /// State after.
    pub to: usize,
}

/// Transitions and diffusion learned from a logged drive with slip. [Kasprzak & Szynkiewicz, Sec. 2.2, Eqs. 3–5]
///
/// Logged moves are counted by state and action, beside one move that goes as commanded ([`TransitionCounts`]). A short drive leaves most states
/// uncounted, so a [`DiffusionKernel`] follows. Its widths $`σ`$ maximize the likelihood of each move, predicted by the others:
///
/// ```math
/// \max_σ \sum_i \log \sum_t k_σ(s'_i - t)\, p_{-i}(t \mid s_i, a_i)
/// ```
///
/// ```
/// use wayfix_condensation::{GridMove, LearnedMotion, LoggedMove, PositionGrid, TransitionModel};
/// let grid = PositionGrid::new(20, 1)?;
/// let action = GridMove { dx: 1, dy: 0 };
/// // Every fourth move slips.
/// let drive: Vec<_> = (0..16).map(|from| LoggedMove { from, action, to: from + usize::from(from % 4 != 0) }).collect();
/// let learned = LearnedMotion::learn(&grid, &drive)?;
/// let mut predicted = [0.0; 20];
/// learned.transition(action).expect("an action of grids").predict(&std::array::from_fn::<_, 20, _>(|s| f64::from(u8::from(s == 18))), &mut predicted);
/// assert!(predicted[19] > predicted[18] && predicted[18] > 0.05); // a state that was never left slips too
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LearnedMotion {
    transitions: Vec<SparseTransition>,
    sigmas: [f64; 2],
    n_moves: usize,
}

impl LearnedMotion {
    /// Learns from the moves of a drive.
    ///
    /// # Errors
    /// [`CondensationError::Empty`] without moves or for an unknown action, [`CondensationError::State`].
    pub fn learn(grid: &PositionGrid, moves: &[LoggedMove]) -> Result<Self, CondensationError> {
        if moves.is_empty() {
            return Err(CondensationError::Empty { what: "moves" });
        }
        let mut counts = TransitionCounts::new(grid);
        for &LoggedMove { from, action, to } in moves {
            check_state(from, grid.n_states())?;
            counts.record(from, action, to)?;
        }
        let (columns, rows) = (AxisKernels::new(grid.columns())?, AxisKernels::new(grid.rows())?);
        let predictions: Vec<_> = (0..moves.len()).map(|i| without(grid, moves, i)).collect();
        let log_likelihood = |column: &DiffusionKernel, row: &DiffusionKernel| -> f64 {
            let share = |(made, predicted): (&LoggedMove, &Vec<(usize, f64)>)| -> f64 {
                let (x, y) = grid.place(made.to);
                let from = |&(t, p): &(usize, f64)| {
                    let (at_x, at_y) = grid.place(t);
                    p * column.share(at_x, x) * row.share(at_y, y)
                };
                predicted.iter().map(from).sum::<f64>().ln()
            };
            moves.iter().zip(&predictions).map(share).sum()
        };
        let mut best = (f64::NEG_INFINITY, 0, 0);
        for (i, column) in columns.kernels.iter().enumerate() {
            for (j, row) in rows.kernels.iter().enumerate() {
                let value = log_likelihood(column, row);
                if value > best.0 {
                    best = (value, i, j);
                }
            }
        }
        let (_, i, j) = best;
        let spread = |t: usize| {
            let (x, y) = grid.place(t);
            let (column, row) = (&columns.kernels[i], &rows.kernels[j]);
            (0..grid.rows()).map(move |to| (to, row.share(y, to))).filter(|(_, p)| *p > 0.0).flat_map(
                move |(to_y, p_y)| {
                    (0..grid.columns()).filter_map(move |to_x| {
                        let p = p_y * column.share(x, to_x);
                        (p > 0.0).then_some((to_y * grid.columns() + to_x, p))
                    })
                },
            )
        };
        let transition = |&action: &GridMove| {
            let counted = counts.transition(action, PRIOR_MOVES)?;
            let mut leaving = vec![Vec::new(); grid.n_states()];
            for t in 0..grid.n_states() {
                for (from, p) in counted.into_state(t) {
                    leaving[from].extend(spread(t).map(|(to, share)| (to, p * share)));
                }
            }
            SparseTransition::from_rows(leaving)
        };
        Ok(Self {
            transitions: grid.actions().iter().map(transition).collect::<Result<_, _>>()?,
            sigmas: [columns.sigmas[i], rows.sigmas[j]],
            n_moves: moves.len(),
        })
    }

    /// Transition and diffusion of an action, one after the other.
    pub fn transition(&self, action: GridMove) -> Option<&SparseTransition> {
        GridMove::ALL.iter().position(|known| *known == action).map(|index| &self.transitions[index])
    }

    /// The same of every action, in the order of [`GridMove::ALL`].
    pub fn transitions(&self) -> &[SparseTransition] {
        &self.transitions
    }

    /// Widths of the diffusion along columns and rows, in states.
    pub fn diffusion_sigmas(&self) -> [f64; 2] {
        self.sigmas
    }

    /// Number of moves that it was learned from.
    pub fn n_moves(&self) -> usize {
        self.n_moves
    }
}

/// Where the other moves of a drive say that move number `i` leads: the shares of [`TransitionCounts`] without it.
fn without(grid: &PositionGrid, moves: &[LoggedMove], i: usize) -> Vec<(usize, f64)> {
    let LoggedMove { from, action, .. } = moves[i];
    let alike = moves.iter().enumerate().filter(|(j, other)| *j != i && other.from == from);
    let targets: Vec<usize> =
        alike.filter(|(_, other)| other.action == action).map(|(_, other)| other.to).collect();
    let total = targets.len() as f64 + PRIOR_MOVES;
    let expected = (grid.step(from, action), PRIOR_MOVES / total);
    targets.into_iter().map(|to| (to, 1.0 / total)).chain([expected]).collect()
}

/// Diffusion along one axis, for every width that is compared; the first is none.
struct AxisKernels {
    sigmas: Vec<f64>,
    kernels: Vec<DiffusionKernel>,
}

impl AxisKernels {
    fn new(len: usize) -> Result<Self, CondensationError> {
        let line = PositionGrid::new(len, 1)?;
        let widths = std::iter::successors(Some(MIN_SIGMA), |sigma| Some(sigma * RATIO));
        let sigmas: Vec<f64> =
            std::iter::once(0.0).chain(widths.take_while(|sigma| *sigma < len as f64 && len > 1)).collect();
        let kernels = sigmas.iter().map(|&sigma| DiffusionKernel::gaussian(&line, &[0.0, sigma]));
        let kernels = kernels.collect::<Result<_, _>>()?;
        Ok(Self { sigmas, kernels })
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, Normal};

    use super::*;
    use crate::TransitionModel;

    const RIGHT: GridMove = GridMove { dx: 1, dy: 0 };

    /// Moves whose end is off by rounded Gaussian noise, each from another state.
    fn noisy(grid: &PositionGrid, sigmas: [f64; 2], n: usize) -> Vec<LoggedMove> {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let off = sigmas.map(|sigma| Normal::new(0.0, sigma).unwrap());
        let one = |_| {
            let (x, y) = (rng.random_range(10..grid.columns() - 10), rng.random_range(10..grid.rows() - 10));
            let [dx, dy] = [0, 1].map(|axis| off[axis].sample(&mut rng).round() as isize);
            let to = (x + 1).saturating_add_signed(dx) + y.saturating_add_signed(dy) * grid.columns();
            LoggedMove { from: y * grid.columns() + x, action: RIGHT, to }
        };
        (0..n).map(one).collect()
    }

    /// Rounding adds a twelfth to the variance; the standard error of a sigma is σ / sqrt(2n), below the step between widths.
    #[test]
    fn widths_of_the_slip_are_found() {
        let grid = PositionGrid::new(60, 50).unwrap();
        let learned = LearnedMotion::learn(&grid, &noisy(&grid, [1.5, 0.7], 600)).unwrap();
        for (got, sigma) in learned.diffusion_sigmas().into_iter().zip([1.5_f64, 0.7]) {
            let expected = (sigma * sigma + 1.0 / 12.0).sqrt();
            assert!(got / expected < RATIO && expected / got < RATIO, "{got} for {expected}");
        }
    }

    #[test]
    fn a_drive_without_slip_needs_no_diffusion() {
        let grid = PositionGrid::new(30, 1).unwrap();
        let drive: Vec<_> = (0..29).map(|from| LoggedMove { from, action: RIGHT, to: from + 1 }).collect();
        let learned = LearnedMotion::learn(&grid, &drive).unwrap();
        assert_eq!((learned.diffusion_sigmas(), learned.n_moves()), ([0.0; 2], 29));
        let mut predicted = [0.0; 30];
        learned
            .transition(RIGHT)
            .unwrap()
            .predict(&std::array::from_fn::<_, 30, _>(|s| if s == 4 { 1.0 } else { 0.0 }), &mut predicted);
        assert_eq!(predicted[5], 1.0);
    }

    /// A state whose every move slips is known by its counts; the others need no diffusion for it.
    #[test]
    fn counts_explain_what_happens_at_one_state() {
        let grid = PositionGrid::new(12, 1).unwrap();
        let made = |from: usize, to: usize| LoggedMove { from, action: RIGHT, to };
        let mut drive: Vec<_> = (0..400).map(|i| made(i % 11, i % 11 + 1)).collect();
        drive.iter_mut().filter(|made| made.from == 3).for_each(|made| made.to = 3);
        let learned = LearnedMotion::learn(&grid, &drive).unwrap();
        let from_state = |state: usize| {
            let mut predicted = [0.0; 12];
            let belief = std::array::from_fn::<_, 12, _>(|s| if s == state { 1.0 } else { 0.0 });
            learned.transition(RIGHT).unwrap().predict(&belief, &mut predicted);
            predicted
        };
        assert!(from_state(3)[3] > 0.9, "{:?}", from_state(3));
        assert!(from_state(7)[8] > 0.9, "{:?}", from_state(7));
    }

    #[test]
    fn unusable_moves_are_refused() {
        let grid = PositionGrid::new(3, 1).unwrap();
        let refused = |moves: &[LoggedMove]| LearnedMotion::learn(&grid, moves).unwrap_err();
        assert!(matches!(refused(&[]), CondensationError::Empty { .. }));
        let far = LoggedMove { from: 0, action: GridMove { dx: 2, dy: 0 }, to: 1 };
        assert!(matches!(refused(&[far]), CondensationError::Empty { .. }));
        let outside = LoggedMove { from: 0, action: RIGHT, to: 3 };
        assert!(matches!(refused(&[outside]), CondensationError::State { .. }));
    }

    #[test]
    fn share_of_a_kernel_is_what_it_predicts() {
        let line = PositionGrid::new(9, 1).unwrap();
        for sigma in [0.0, 0.5, 2.0, 30.0] {
            let kernel = DiffusionKernel::gaussian(&line, &[0.0, sigma]).unwrap();
            for from in 0..9 {
                let (mut unit, mut predicted) = ([0.0; 9], [0.0; 9]);
                unit[from] = 1.0;
                kernel.predict(&unit, &mut predicted);
                assert_eq!(predicted, std::array::from_fn(|to| kernel.share(from, to)), "{sigma} {from}");
            }
        }
    }

    #[test]
    fn long_route_is_learned_in_little_memory() {
        // A matrix for each width would take 11 GB.
        let grid = PositionGrid::new(5000, 1).unwrap();
        let moves: Vec<LoggedMove> = (0..100)
            .map(|k| LoggedMove { from: 49 * k, action: RIGHT, to: 49 * k + 1 + usize::from(k % 4 == 0) })
            .collect();
        let learned = LearnedMotion::learn(&grid, &moves).unwrap();
        // One move of four goes a state too far: σ² = 1/4, here within a factor of two of σ.
        assert!((0.25..1.0).contains(&learned.diffusion_sigmas()[0]), "{:?}", learned.diffusion_sigmas());
    }
}
