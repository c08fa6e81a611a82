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
    /// The effective sample size as a share of the particles, in (0, 1]. Filters customarily resample below one half. [Liu & Chen 1998]
    ///
    /// ```
    /// use wayfix_particle::NormalizationReport;
    /// let report = NormalizationReport { log_likelihood: -2.0, effective_sample_size: 40.0, n_particles: 100 };
    /// assert_eq!(report.effective_share(), 0.4);
    /// ```
    pub fn effective_share(&self) -> f64 {
        self.effective_sample_size / self.n_particles as f64
    }
}
