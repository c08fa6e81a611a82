use std::collections::HashSet;
use std::hash::{BuildHasherDefault, DefaultHasher, Hash};

use rand::{Rng, RngExt as _};
use statrs::distribution::{ContinuousCDF as _, Normal};

use crate::{NormalizedWeights, ParticleError, ParticleSet};

/// How well the particles must stand for the posterior.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KldParams {
    /// Largest Kullback-Leibler divergence between the binned posterior and its particles, nats. Default 0.05.
    pub epsilon: f64,
    /// Probability that the divergence stays below, in [0.5, 1). Default 0.99.
    pub confidence: f64,
    /// Fewest particles. Default 100.
    pub min_particles: usize,
    /// Most particles. Default 5000.
    pub max_particles: usize,
}

impl Default for KldParams {
    fn default() -> Self {
        Self { epsilon: 0.05, confidence: 0.99, min_particles: 100, max_particles: 5000 }
    }
}

/// KLD-sampling: the number of particles from the spread of the posterior. [Fox 2003]
///
/// ```
/// use wayfix_particle::{KldParams, KldSampling};
/// let kld = KldSampling::new(KldParams { epsilon: 0.1, min_particles: 10, ..KldParams::default() })?;
/// assert_eq!(kld.required(1), 10); // all in one bin: the fewest
/// assert!((650..700).contains(&kld.required(101))); // χ² with 100 degrees of freedom at 0.99 is 135.8; over 2 ε
/// # Ok::<(), wayfix_particle::ParticleError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KldSampling {
    params: KldParams,
    /// The quantile of the standard normal distribution at the confidence.
    z: f64,
}

impl KldSampling {
    /// Checks the parameters.
    ///
    /// # Errors
    /// [`ParticleError::Parameter`] naming the one that is outside its range.
    pub fn new(params: KldParams) -> Result<Self, ParticleError> {
        let KldParams { epsilon, confidence, min_particles: min, max_particles: max } = params;
        let parameter = |what, value, range| Err(ParticleError::Parameter { what, value, range });
        if !(epsilon > 0.0 && epsilon.is_finite()) {
            return parameter("epsilon", epsilon, "positive");
        }
        if !(0.5..1.0).contains(&confidence) {
            return parameter("confidence", confidence, "in [0.5, 1)");
        }
        if min == 0 {
            return parameter("min_particles", 0.0, "at least 1");
        }
        if max < min {
            return parameter("max_particles", max as f64, "at least min_particles");
        }
        Ok(Self { params, z: Normal::standard().inverse_cdf(confidence) })
    }

    /// Number of particles that `n_bins` occupied bins require, within the bounds:
    /// $`n = \frac{k-1}{2ε} \Big(1 - \frac{2}{9(k-1)} + \sqrt{\frac{2}{9(k-1)}} \, z_{1-δ}\Big)^3`$. [Fox 2003]
    pub fn required(&self, n_bins: usize) -> usize {
        let KldParams { epsilon, min_particles: min, max_particles: max, .. } = self.params;
        if n_bins < 2 {
            return min;
        }
        let degrees = (n_bins - 1) as f64;
        let share = 2.0 / (9.0 * degrees);
        let chi_squared = degrees * (1.0 - share + share.sqrt() * self.z).powi(3);
        ((chi_squared / (2.0 * epsilon)).ceil() as usize).clamp(min, max)
    }

    /// Draws indices by weight and counts their bins until the number drawn is enough for the bins seen; that number. [Fox 2003]
    pub fn sample_size<K: Hash + Eq, R: Rng + ?Sized>(
        &self,
        weights: &NormalizedWeights,
        bin: impl Fn(usize) -> K,
        rng: &mut R,
    ) -> usize {
        let last = weights.last_positive();
        let mut sum = 0.0;
        let cumulative: Vec<f64> = weights
            .as_slice()
            .iter()
            .map(|weight| {
                sum += weight;
                sum
            })
            .collect();
        // The standard hasher with its fixed key: no crate creates randomness, not even that of hash tables.
        let mut occupied = HashSet::<K, BuildHasherDefault<DefaultHasher>>::default();
        let (mut drawn, mut required) = (0, self.params.min_particles);
        while drawn < required {
            let point: f64 = rng.random();
            let ancestor = cumulative.partition_point(|sum| *sum <= point).min(last);
            if occupied.insert(bin(ancestor)) {
                required = self.required(occupied.len());
            }
            drawn += 1;
        }
        required
    }
}

impl<X> ParticleSet<X> {
    /// The number of particles for the posterior, by [`KldSampling::sample_size`].
    ///
    /// `bin` says where a state belongs, for instance its [`grid_cell`]. The draws only count; [`resample`](Self::resample) with the result,
    /// by any scheme.
    ///
    /// ```
    /// use rand::SeedableRng;
    /// use wayfix_particle::{KldParams, KldSampling, ParticleSet, SystematicResampler, grid_cell};
    /// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
    /// let kld = KldSampling::new(KldParams::default())?;
    /// let mut particles = ParticleSet::new((0..5000).map(|i| f64::from(i) * 1e-4).collect())?;
    /// let n = particles.kld_size(&kld, |x| grid_cell([*x], [0.25]), &mut rng)?;
    /// particles.resample(&SystematicResampler, n, &mut rng)?;
    /// assert_eq!(n, 100); // two bins: 67 would do, the fewest are 100
    /// # Ok::<(), wayfix_particle::ParticleError>(())
    /// ```
    ///
    /// # Errors
    /// [`ParticleError::NoWeight`] when every particle is impossible.
    pub fn kld_size<K: Hash + Eq, R: Rng + ?Sized>(
        &self,
        kld: &KldSampling,
        bin: impl Fn(&X) -> K,
        rng: &mut R,
    ) -> Result<usize, ParticleError> {
        let weights = self.weights()?;
        Ok(kld.sample_size(&weights, |i| bin(&self.states()[i]), rng))
    }
}

/// The cell of a regular grid that holds `coordinates`: $`⌊x_i / w_i⌋`$, the key for [`kld_size`](ParticleSet::kld_size).
///
/// Values that are not finite go to the cells at the ends, NaN to cell 0.
///
/// ```
/// assert_eq!(wayfix_particle::grid_cell([0.7, -0.1], [0.5, 0.5]), [1, -1]);
/// ```
pub fn grid_cell<const N: usize>(coordinates: [f64; N], widths: [f64; N]) -> [i64; N] {
    std::array::from_fn(|i| (coordinates[i] / widths[i]).floor() as i64)
}
