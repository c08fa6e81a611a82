use std::collections::BTreeSet;

use nalgebra::DMatrix;

use super::area::CompressedCovariance;
use crate::covariance::JointCovariance;

impl CompressedCovariance {
    /// The whole covariance.
    pub(in crate::covariance) fn matrix(&self) -> DMatrix<f64> {
        let mut settled = self.clone();
        settled.global_update();
        settled.deferred.finish(&mut settled.base);
        settled.base.matrix().into_owned()
    }

    /// Makes the whole map the area: nothing is outside, so nothing is deferred.
    pub(super) fn activate_all(&mut self) {
        self.global_update();
        self.deferred.finish(&mut self.base);
        self.local = self.base.clone();
        let n = self.rows.len();
        self.rows = (0..n).map(Some).collect();
        self.area = (0..n).collect();
    }

    /// Propagates the information of the area to the rest of the map, and continues with an area of these states only.
    pub(super) fn restart(&mut self, area: &BTreeSet<usize>) {
        self.global_update();
        self.area = area.iter().copied().collect();
        let n = self.area.len();
        let base = self.base.matrix();
        let kept = DMatrix::from_fn(n, n, |i, j| base[(self.area[i], self.area[j])]);
        self.local = JointCovariance::from_matrix(kept);
        self.rows.fill(None);
        for (row, state) in self.area.iter().enumerate() {
            self.rows[*state] = Some(row);
        }
        self.add_influences(&self.area.clone());
    }
}
