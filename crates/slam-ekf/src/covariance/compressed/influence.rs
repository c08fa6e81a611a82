use super::area::{CompressedCovariance, Influence};

impl CompressedCovariance {
    /// Creates the influences of states that have just entered the area: one step of a Cholesky factorization of the base each.
    ///
    /// The new influence is the standardized residual of a state given the earlier influences. It is correlated with no other and with no state
    /// of the area except `new_states`. If only rounding is left of a variance, it is raised, not set to zero: covariances are of the size of
    /// its root.
    pub(super) fn add_influences(&mut self, new_states: &[usize]) {
        for &state in new_states {
            let base = self.base.matrix();
            let mut loadings: Vec<f64> = base.column(state).iter().copied().collect();
            for earlier in &self.influences {
                let factor = earlier.loadings[state];
                for (loading, of_earlier) in loadings.iter_mut().zip(&earlier.loadings) {
                    *loading -= factor * of_earlier;
                }
            }
            let smallest = RANK_TOLERANCE * base[(state, state)];
            let lifted = (smallest - loadings[state]).max(0.0);
            let variance = loadings[state] + lifted;
            if variance <= 0.0 {
                continue;
            }
            let scale = 1.0 / variance.sqrt();
            loadings.iter_mut().for_each(|loading| *loading *= scale);
            let row = self.local.dimension();
            self.local.extend_with_zeros(1);
            let mut local = self.local.matrix_mut();
            local[(row, row)] = 1.0;
            if let Some(own) = self.rows[state] {
                local[(own, own)] += lifted;
            }
            loadings[state] += scale * lifted;
            for &newcomer in new_states {
                if let Some(own) = self.rows[newcomer] {
                    local[(own, row)] = loadings[newcomer];
                    local[(row, own)] = loadings[newcomer];
                }
            }
            self.influences.push(Influence { row, loadings, step: 0.0 });
        }
    }
}

/// Remainder of a variance from which everything is subtracted: some tens of ε.
const RANK_TOLERANCE: f64 = 1e-14;
