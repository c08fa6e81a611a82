use rand::Rng;

use super::deviate::normal;

/// A time-correlated error: a stationary first-order Gauss-Markov process of variance 1.
///
/// $`x_{k+1} = φ x_k + \sqrt{1 - φ^2}\, n_k`$ with $`φ = e^{-Δt/τ}`$, so that the correlation after $`t`$ seconds is $`e^{-t/τ}`$.
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_scene_sim::random::GaussMarkovProcess;
/// let mut rng = ChaCha8Rng::seed_from_u64(7);
/// let mut drift = GaussMarkovProcess::new(60.0);
/// let (now, soon) = (drift.advance(0.1, &mut rng), drift.advance(0.1, &mut rng));
/// assert!((now - soon).abs() < 0.3); // 5σ of one step is 5·√(2·0.1/60)
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct GaussMarkovProcess {
    correlation_time_s: f64,
    state: Option<f64>,
}

impl GaussMarkovProcess {
    /// A process with correlation time τ in seconds; 0 makes white noise.
    pub fn new(correlation_time_s: f64) -> Self {
        Self { correlation_time_s, state: None }
    }

    /// The value `step_s` (above 0) after the last one; the first is drawn from the stationary distribution. Two draws.
    pub fn advance<R: Rng + ?Sized>(&mut self, step_s: f64, rng: &mut R) -> f64 {
        let fresh = normal(rng);
        let next = match self.state {
            None => fresh,
            Some(last) => {
                let phi = libm::exp(-step_s / self.correlation_time_s);
                phi * last + (1.0 - phi * phi).sqrt() * fresh
            }
        };
        self.state = Some(next);
        next
    }
}
