use nalgebra::{DMatrix, DVector, DefaultAllocator, DimName, OMatrix, allocator::Allocator};

use super::{deferred::DeferredCorrection, schedule::Schedule};
use crate::covariance::{JointCovariance, ROUNDING, SparseJacobian};

/// A covariance in two parts: the area around the robot, and the whole map at the time when the area was chosen.
#[derive(Clone, Debug)]
pub(crate) struct CompressedCovariance {
    /// Area and influences. The robot comes first.
    pub(super) local: JointCovariance,
    /// The row in `local` of every state of the map; `None` outside the area.
    pub(super) rows: Vec<Option<usize>>,
    /// The states that have a row.
    pub(super) area: Vec<usize>,
    pub(super) influences: Vec<Influence>,
    /// The whole map at the time when the area was chosen, for pairs outside the area; the backlog is still to be subtracted.
    pub(super) base: JointCovariance,
    pub(super) deferred: DeferredCorrection,
    /// Deferred steps of the filter's means, without the contribution of the influences outside the area.
    pub(super) lag: DVector<f64>,
    /// Corrections since the area was chosen: each adds a rounding allowance to every variance.
    pub(super) n_corrections: usize,
    pub(super) schedule: Schedule,
}

/// One of the variables $`v`$ through which the area and the rest of the map are correlated.
#[derive(Clone, Debug)]
pub(super) struct Influence {
    /// Its row in `local`.
    pub(super) row: usize,
    /// Its column of $`B`$, one entry per state of the map; those of the area are unused.
    pub(super) loadings: Vec<f64>,
    /// Displacement of its mean.
    pub(super) step: f64,
}

impl CompressedCovariance {
    /// At first the area is the whole map: there are no influences.
    pub(in crate::covariance) fn from_robot<R: DimName>(robot: &OMatrix<f64, R, R>) -> Self
    where
        DefaultAllocator: Allocator<R, R>,
    {
        Self {
            local: JointCovariance::from_robot(robot),
            rows: (0..R::DIM).map(Some).collect(),
            area: (0..R::DIM).collect(),
            influences: Vec::new(),
            base: JointCovariance::from_robot(robot),
            deferred: DeferredCorrection::default(),
            lag: DVector::zeros(R::DIM),
            n_corrections: 0,
            schedule: Schedule::for_robot_states(R::DIM),
        }
    }

    /// The area is the whole map.
    pub(in crate::covariance) fn from_matrix(n_robot: usize, matrix: DMatrix<f64>) -> Self {
        let n = matrix.nrows();
        let base = JointCovariance::from_matrix(matrix);
        Self {
            local: base.clone(),
            rows: (0..n).map(Some).collect(),
            area: (0..n).collect(),
            influences: Vec::new(),
            base,
            deferred: DeferredCorrection::default(),
            lag: DVector::zeros(n),
            n_corrections: 0,
            schedule: Schedule::for_robot_states(n_robot),
        }
    }

    pub(in crate::covariance) fn robot<R: DimName>(&self) -> OMatrix<f64, R, R>
    where
        DefaultAllocator: Allocator<R, R>,
    {
        self.local.robot()
    }

    /// As [`JointCovariance::move_robot`], in the size of the area.
    pub(in crate::covariance) fn move_robot<R: DimName>(
        &mut self,
        jacobian: &OMatrix<f64, R, R>,
        noise: &OMatrix<f64, R, R>,
    ) where
        DefaultAllocator: Allocator<R, R> + Allocator<R>,
    {
        self.local.move_robot(jacobian, noise);
    }

    /// As [`JointCovariance::append`]; the new block is in the area.
    pub(in crate::covariance) fn append<L: DimName, R: DimName>(
        &mut self,
        robot_jacobian: &OMatrix<f64, L, R>,
        noise: &OMatrix<f64, L, L>,
    ) -> usize
    where
        DefaultAllocator: Allocator<L, L>
            + Allocator<L, R>
            + Allocator<R, L>
            + Allocator<R, R>
            + Allocator<R>
            + Allocator<L>,
    {
        let row = self.local.append(robot_jacobian, noise);
        let state = self.rows.len();
        self.base.extend_with_zeros(L::DIM);
        for influence in &mut self.influences {
            influence.loadings.resize(state + L::DIM, 0.0);
        }
        self.rows.extend((0..L::DIM).map(|i| Some(row + i)));
        self.area.extend(state..state + L::DIM);
        self.lag.resize_vertically_mut(state + L::DIM, 0.0);
        self.schedule.note_landmark(state..state + L::DIM);
        state
    }

    /// As [`JointCovariance::correct`], in the size of the area. The step is the one of the means as the filter holds them: for what is
    /// outside the area it may come later.
    pub(in crate::covariance) fn correct(
        &mut self,
        jacobian: &SparseJacobian,
        noise: &DMatrix<f64>,
        residual: &DVector<f64>,
    ) -> Option<DVector<f64>> {
        for landmark in jacobian.landmarks() {
            self.activate(landmark.clone());
            self.schedule.note_landmark(landmark);
        }
        let in_area = jacobian.relocated(|state| self.rows[state].expect("activated above"));
        let lifted: Vec<f64> = self.influences.iter().map(|v| ROUNDING * self.variance(v)).collect();
        let step = self.local.correct(&in_area, noise, residual)?;
        for &state in &self.area {
            self.lag[state] += self.rows[state].map_or(0.0, |row| step[row]);
        }
        for (influence, lifted) in self.influences.iter_mut().zip(lifted) {
            influence.step += step[influence.row];
            // The states outside get the rounding allowance, not the influence: there it would correlate them.
            self.local.matrix_mut()[(influence.row, influence.row)] -= lifted;
        }
        self.n_corrections += 1;
        self.schedule.note_rows(jacobian.nrows());
        let caught_up = DVector::zeros(self.lag.len());
        Some(std::mem::replace(&mut self.lag, caught_up))
    }

    fn variance(&self, influence: &Influence) -> f64 {
        self.local.matrix()[(influence.row, influence.row)]
    }

    /// The sum of the rounding allowances that a full map would have added to a variance outside, from `first` when the area was chosen until
    /// now.
    pub(super) fn rounding_allowance(&self, first: f64, now: f64) -> f64 {
        0.5 * (first + now) * ROUNDING * self.n_corrections as f64
    }
}
