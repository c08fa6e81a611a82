use std::ops::Range;

use super::{
    area::{CompressedCovariance, Influence},
    passive::Reach,
};

impl CompressedCovariance {
    /// Takes a landmark block into the area. Its value does not change, only where it is kept.
    ///
    /// With $`p = P_{aj,0}`$: $`Φ ← \begin{pmatrix} Φ & 0 \\ -p^T Ψ & I \end{pmatrix}`$, $`Ψ ← \begin{pmatrix} Ψ & 0 \\ 0 & 0 \end{pmatrix}`$.
    pub(super) fn activate(&mut self, states: Range<usize>) {
        if self.rows[states.start].is_some() {
            return;
        }
        self.backlog.settle(states.clone(), &mut self.base); // from now on these columns of the base carry an influence
        let Reach { with_local, own } = self.reach(states.clone());
        for state in states.clone() {
            self.lag[state] += self.influenced(state);
        }
        let start = self.local.dimension();
        self.local.extend_with_zeros(2 * states.len());
        let mut local = self.local.matrix_mut();
        let size = states.len();
        local.view_mut((0, start), (start, size)).copy_from(&with_local);
        local.view_mut((start, 0), (size, start)).copy_from(&with_local.transpose());
        local.view_mut((start, start), (size, size)).copy_from(&own);
        for (i, state) in states.enumerate() {
            let (row, influence) = (start + i, start + size + i);
            local[(row, influence)] = 1.0;
            local[(influence, row)] = 1.0;
            self.rows[state] = Some(row);
            self.area.push(state);
            self.influences.push(Influence { state, row: influence, step: 0.0 });
        }
    }
}
