use rand::{Rng, RngExt as _};
use wayfix_estimation_traits::LogWeight;

use crate::{ParticleError, ParticleSet, weights::check_log_weights};

/// How fast the two averages of [`InjectionMonitor`] forget.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InjectionParams {
    /// Share of the newest likelihood in the long-term average, above 0. Default 0.001.
    pub slow: f64,
    /// Share of the newest likelihood in the short-term average, above `slow`, at most 1. Default 0.1.
    pub fast: f64,
}

impl Default for InjectionParams {
    fn default() -> Self {
        Self { slow: 0.001, fast: 0.1 }
    }
}

/// Detects a decrease of the measurement likelihood and computes the share of particles to replace by random ones.
/// [Thrun, Burgard & Fox 2005, Table 8.3]
///
/// $`w_\text{slow} ← w_\text{slow} + α_\text{slow} (w - w_\text{slow})`$, likewise $`w_\text{fast}`$; injected is the share
/// $`\max(0, 1 - w_\text{fast} / w_\text{slow})`$. Kept as logarithms, since likelihoods of images have no plain value. Both start at the first
/// likelihood instead of 0.
///
/// Likelihoods must be comparable from one measurement to the next. Where the number of observations changes, give the mean nats per
/// observation.
///
/// ```
/// use wayfix_particle::{InjectionMonitor, InjectionParams};
/// let mut monitor = InjectionMonitor::new(InjectionParams { slow: 0.01, fast: 0.5 })?;
/// for _ in 0..10 {
///     assert_eq!(monitor.observe(-5000.0)?, 0.0); // bad, but as ever
/// }
/// assert!(monitor.observe(-5007.0)? > 0.4); // kidnapped
/// # Ok::<(), wayfix_particle::ParticleError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InjectionMonitor {
    params: InjectionParams,
    averages: Option<Averages>,
}

/// Logarithms of both averages.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Averages {
    slow: LogWeight,
    fast: LogWeight,
}

impl InjectionMonitor {
    /// Checks the parameters.
    ///
    /// # Errors
    /// [`ParticleError::Parameter`] naming the one that is outside its range.
    pub fn new(params: InjectionParams) -> Result<Self, ParticleError> {
        let InjectionParams { slow, fast } = params;
        if !(slow > 0.0 && slow < 1.0) {
            return Err(ParticleError::Parameter { what: "slow", value: slow, range: "in (0, 1)" });
        }
        if !(fast > slow && fast <= 1.0) {
            return Err(ParticleError::Parameter {
                what: "fast",
                value: fast,
                range: "above slow and at most 1",
            });
        }
        Ok(Self { params, averages: None })
    }

    /// Takes the mean likelihood of the particles, in nats (say [`NormalizationReport::log_likelihood`](crate::NormalizationReport::log_likelihood));
    /// the share of particles to replace.
    ///
    /// # Errors
    /// [`ParticleError::LogWeight`] for NaN and positive infinity; the averages are as they were. $`-∞`$ is legal: nothing was explained.
    pub fn observe(&mut self, log_likelihood: LogWeight) -> Result<f64, ParticleError> {
        check_log_weights(&[log_likelihood])?;
        let Averages { slow, fast } =
            self.averages.unwrap_or(Averages { slow: log_likelihood, fast: log_likelihood });
        self.averages = Some(Averages {
            slow: log_average(slow, log_likelihood, self.params.slow),
            fast: log_average(fast, log_likelihood, self.params.fast),
        });
        Ok(self.share())
    }

    /// The share of particles to replace, in [0, 1]: 0 before the first likelihood, 1 while nothing was explained yet.
    pub fn share(&self) -> f64 {
        match self.averages {
            None => 0.0,
            Some(Averages { slow: f64::NEG_INFINITY, .. }) => 1.0,
            // Not 1 - exp: close to equal averages would lose their digits.
            Some(Averages { slow, fast }) => (-(fast - slow).exp_m1()).max(0.0),
        }
    }

    /// Forgets both averages, as one does after many particles were replaced, lest more and more are.
    pub fn reset(&mut self) {
        self.averages = None;
    }
}

/// $`\log((1 - α) e^a + α e^b)`$.
fn log_average(average: LogWeight, newest: LogWeight, alpha: f64) -> LogWeight {
    let (old, new) = (average + (1.0 - alpha).ln(), newest + alpha.ln());
    let larger = old.max(new);
    if larger == f64::NEG_INFINITY || average == newest {
        return average.max(newest); // nothing to average; and no rounding either
    }
    larger + ((old - larger).exp() + (new - larger).exp()).ln()
}

impl<X> ParticleSet<X> {
    /// Replaces each particle with probability `share` by a fresh one, which takes over its weight; how many were replaced.
    ///
    /// Meant for particles of equal weight, after [`resample`](Self::resample).
    ///
    /// ```
    /// use rand::{RngExt, SeedableRng};
    /// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
    /// let mut particles = wayfix_particle::ParticleSet::new(vec![0.0; 1000])?;
    /// let n = particles.inject(0.1, |rng| rng.random_range(5.0..9.0), &mut rng)?;
    /// assert_eq!(particles.states().iter().filter(|x| **x >= 5.0).count(), n);
    /// assert!((50..150).contains(&n)); // five sigma
    /// # Ok::<(), wayfix_particle::ParticleError>(())
    /// ```
    ///
    /// # Errors
    /// [`ParticleError::Parameter`] when `share` is not in [0, 1].
    pub fn inject<R: Rng + ?Sized>(
        &mut self,
        share: f64,
        mut draw: impl FnMut(&mut R) -> X,
        rng: &mut R,
    ) -> Result<usize, ParticleError> {
        if !(0.0..=1.0).contains(&share) {
            return Err(ParticleError::Parameter { what: "share", value: share, range: "in [0, 1]" });
        }
        let mut n_injected = 0;
        for state in &mut self.states {
            if rng.random_bool(share) {
                *state = draw(rng);
                n_injected += 1;
            }
        }
        Ok(n_injected)
    }
}
