use nalgebra::{DMatrix, DefaultAllocator, DimName, OMatrix, OVector, allocator::Allocator};

use super::area::{CompressedCovariance, Influence};

/// The covariance of a landmark with the area.
pub(super) struct OutsideBlock {
    /// Covariance with all rows of the area and the influences: one column per state of the landmark.
    pub(super) with_local: DMatrix<f64>,
    /// Its own covariance.
    pub(super) own: DMatrix<f64>,
}

impl CompressedCovariance {
    /// Covariance of a landmark block with the robot, and its own. In the size of the area when the landmark is inside, squared when outside.
    pub(in crate::covariance) fn landmark_blocks<L: DimName, R: DimName>(
        &self,
        offset: usize,
    ) -> (OMatrix<f64, L, R>, OMatrix<f64, L, L>)
    where
        DefaultAllocator: Allocator<L, R> + Allocator<L, L>,
    {
        if let Some(row) = self.rows[offset] {
            return self.local.landmark_blocks(row);
        }
        let OutsideBlock { with_local, own } = self.outside_block(offset..offset + L::DIM);
        let with_robot = OMatrix::<f64, L, R>::from_fn(|i, robot| with_local[(robot, i)]);
        (with_robot, OMatrix::<f64, L, L>::from_fn(|i, j| own[(i, j)]))
    }

    /// Covariance of one state of the map with another.
    pub(in crate::covariance) fn entry(&self, one: usize, other: usize) -> f64 {
        let local = self.local.matrix();
        match (self.rows[one], self.rows[other]) {
            (Some(row), Some(column)) => local[(row, column)],
            (None, Some(_)) => self.entry(other, one),
            (Some(row), None) => {
                self.influences.iter().map(|v| v.loadings[other] * local[(row, v.row)]).sum()
            }
            (None, None) => {
                let OutsideBlock { own, .. } = self.outside_block([one.min(other), one.max(other)]);
                own[(0, 1)]
            }
        }
    }

    /// The deferred step of the filter's mean of a landmark block; `None` if there is none.
    pub(in crate::covariance) fn deferred_step<L: DimName>(&self, offset: usize) -> Option<OVector<f64, L>>
    where
        DefaultAllocator: Allocator<L>,
    {
        let step = OVector::<f64, L>::from_fn(|i, _| self.lag[offset + i] + self.influenced(offset + i));
        step.iter().any(|entry| *entry != 0.0).then_some(step)
    }

    /// $`B \, δv`$ of one state; nothing for a state of the area, which is corrected at once.
    pub(super) fn influenced(&self, state: usize) -> f64 {
        match self.rows[state] {
            Some(_) => 0.0,
            None => self.influences.iter().map(|v| v.loadings[state] * v.step).sum(),
        }
    }

    /// Covariances of states outside the area: $`P_{j·} = B_j P_{v·}`$, $`P_{jj} = P_{jj,0} - B_j (I - P_{vv}) B_j^T`$.
    pub(super) fn outside_block(&self, states: impl IntoIterator<Item = usize>) -> OutsideBlock {
        let states: Vec<usize> = states.into_iter().collect();
        let (base, local) = (self.base.matrix(), self.local.matrix());
        let mut with_local = DMatrix::zeros(local.nrows(), states.len());
        for (&state, mut column) in states.iter().zip(with_local.column_iter_mut()) {
            for v in &self.influences {
                column.axpy(v.loadings[state], &local.column(v.row), 1.0);
            }
        }
        let own = DMatrix::from_fn(states.len(), states.len(), |i, j| {
            let (one, other) = (states[i.min(j)], states[i.max(j)]); // the same bits on both sides
            let change =
                |v: &Influence| v.loadings[one] * (with_local[(v.row, i.max(j))] - v.loadings[other]);
            let first = base[(one, other)] - self.deferred.pending(one, other);
            let now = first + self.influences.iter().map(change).sum::<f64>();
            now + if one == other { self.rounding_allowance(first, now) } else { 0.0 }
        });
        OutsideBlock { with_local, own }
    }
}
