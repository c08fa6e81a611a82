use wayfix_estimation_traits::Policy;

/// The result of a normalization: the likelihood of the measurement and the effective sample size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalizationReport {
    /// $`\log \sum_i w_i e^{l_i}`$ in nats: the filter's estimate of $`\log p(z_k | z_{1:k-1})`$ when the weights were normalized before.
    pub log_likelihood: f64,
    /// $`1 / \sum_i w_i^2`$ of the normalized weights.
    pub effective_sample_size: f64,
    /// How many particles there are.
    pub n_particles: usize,
}

impl NormalizationReport {
    /// The effective sample size as a share of the particles, in (0, 1].
    pub fn effective_share(&self) -> f64 {
        self.effective_sample_size / self.n_particles as f64
    }
}

/// See [`ess_below`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EssBelow(f64);

/// Acts when the effective sample size is below `share` of the particles; one half is customary. [Liu & Chen 1998]
///
/// ```
/// use wayfix_estimation_traits::Policy;
/// use wayfix_particle::{NormalizationReport, ess_below};
/// let evidence = NormalizationReport { log_likelihood: -2.0, effective_sample_size: 40.0, n_particles: 100 };
/// assert!(ess_below(0.5).fires(&evidence) && !ess_below(0.3).fires(&evidence));
/// ```
pub fn ess_below(share: f64) -> EssBelow {
    EssBelow(share)
}

impl Policy<NormalizationReport> for EssBelow {
    fn fires(&mut self, evidence: &NormalizationReport) -> bool {
        evidence.effective_share() < self.0
    }
}
