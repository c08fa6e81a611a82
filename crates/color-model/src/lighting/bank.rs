use std::sync::Arc;

use rand::{Rng, RngExt};
use wayfix_gaussian_core::log_sum_exp;
use wayfix_kalman::MarkovChain;

use super::{ColorMeans, LightingFilter};
use crate::ColorModelError;

/// Lighting filters for different kinds of light (dark, bright), one active at a time; a Markov chain models the switches.
///
/// Only the active filter learns; the others keep their state. [Schulz & Fox 2004, §III.A.3] A particle filter draws the active index for each
/// particle ([`choose`](Self::choose)); with known poses [`JumpMarkovLightingTracker`](super::JumpMarkovLightingTracker) weighs the
/// histories. Clones share their filters until one of them learns.
/// ```
/// use nalgebra::{DMatrix, DVector, Vector3};
/// use wayfix_color_model::{ColorMeans, LightingFilterBank, LightingFilter, LightingFilterParams};
/// use wayfix_gaussian_core::Gaussian;
/// use wayfix_kalman::MarkovChain;
/// let light = |y: f64| {
///     let prior = Gaussian::new(DVector::from_vec(vec![y, 128.0, 128.0]), DMatrix::identity(3, 3) * 400.0)?;
///     LightingFilter::new(prior, LightingFilterParams::default())
/// };
/// let mut bank = LightingFilterBank::new(vec![light(60.0)?, light(160.0)?], MarkovChain::sticky(2, 0.98)?)?;
/// bank.predict(0.04)?;
/// let seen = ColorMeans::new([(Some(Vector3::new(150.0, 128.0, 128.0)), 500)]);
/// bank.update_member(1, &seen)?;
/// assert!((bank.member(1).mean()[0] - 151.4).abs() < 0.1); // 160 - 10 · 400 / 464
/// assert_eq!(bank.member(0).mean()[0], 60.0);
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone, Debug)]
pub struct LightingFilterBank {
    chain: Arc<MarkovChain>,
    settled: Vec<Arc<LightingFilter>>,
    predicted: Vec<Arc<LightingFilter>>,
    active: Option<usize>,
}

/// The filter of a bank that a particle has as active, and its likelihood of the frame.
/// ```
/// # use nalgebra::{DMatrix, DVector};
/// # use rand::SeedableRng;
/// # use wayfix_color_model::{LightingFilter, LightingFilterBank, LightingFilterParams};
/// # use wayfix_gaussian_core::Gaussian;
/// # use wayfix_kalman::MarkovChain;
/// # let prior = Gaussian::new(DVector::from_vec(vec![100.0, 128.0, 128.0]), DMatrix::identity(3, 3) * 400.0)?;
/// # let light = LightingFilter::new(prior, LightingFilterParams::default())?;
/// # let rng = &mut rand_chacha::ChaCha8Rng::seed_from_u64(1);
/// let bank = LightingFilterBank::new(vec![light.clone(), light], MarkovChain::sticky(2, 0.98)?)?;
/// // Before the first image, both members are equally probable.
/// let selected = bank.choose(&[0.2_f64.ln(), 0.6_f64.ln()], rng)?;
/// assert!((selected.log_likelihood - 0.4_f64.ln()).abs() < 1e-12);
/// assert_eq!(bank.choose(&[0.0, f64::NEG_INFINITY], rng)?.member, 0); // the other one is impossible
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelectedLightingFilter {
    /// The member drawn.
    pub member: usize,
    /// $`\ln \sum_j π_{ij}\, p(z | j)`$, nats: the particle's weight, whichever member was drawn.
    pub log_likelihood: f64,
}

impl LightingFilterBank {
    /// A bank of filters for the same colours.
    ///
    /// # Errors
    /// Returns an error if there are none, not as many as the chain has states, or they differ in their number of colours.
    pub fn new(filters: Vec<LightingFilter>, chain: MarkovChain) -> Result<Self, ColorModelError> {
        let (expected, got) = (chain.n_models(), filters.len());
        if expected != got {
            return Err(ColorModelError::Dimension { what: "lighting filters of a chain", expected, got });
        }
        let n_colors = filters.first().map_or(0, LightingFilter::n_colors);
        // All members observe the same number of colours.
        if let Some(other) = filters.iter().map(LightingFilter::n_colors).find(|n| *n != n_colors) {
            return Err(ColorModelError::Dimension {
                what: "colours of a lighting filter",
                expected: n_colors,
                got: other,
            });
        }
        let settled: Vec<_> = filters.into_iter().map(Arc::new).collect();
        Ok(Self { chain: Arc::new(chain), predicted: settled.clone(), settled, active: None })
    }

    /// Merges weighted banks: each member's mixture, matched in mean and covariance; the active member is the one with the largest total
    /// weight.
    /// # Errors
    /// Returns an error if there is no weight, or the banks differ in their members.
    pub fn merged<'a>(
        weighted: impl Iterator<Item = (f64, &'a Self)> + Clone,
    ) -> Result<Self, ColorModelError> {
        let refused = ColorModelError::NotFinite { what: "weight of lighting banks" };
        let mut merged = weighted.clone().next().ok_or(refused.clone())?.1.clone();
        let n_members = merged.n_members();
        if let Some((_, other)) = weighted.clone().find(|(_, bank)| bank.n_members() != n_members) {
            let got = other.n_members();
            return Err(ColorModelError::Dimension {
                what: "members of lighting banks",
                expected: n_members,
                got,
            });
        }
        for member in 0..n_members {
            let filters = weighted.clone().map(|(weight, bank)| (weight, &*bank.settled[member]));
            merged.settled[member] = Arc::new(LightingFilter::merged(filters).ok_or(refused.clone())?);
        }
        merged.predicted = merged.settled.clone();
        let active_weight = |member: usize| -> f64 {
            weighted.clone().filter(|(_, bank)| bank.active == Some(member)).map(|(weight, _)| weight).sum()
        };
        merged.active = (0..n_members)
            .filter(|member| active_weight(*member) > 0.0)
            .max_by(|a, b| active_weight(*a).total_cmp(&active_weight(*b)));
        Ok(merged)
    }

    /// Number of filters.
    pub fn n_members(&self) -> usize {
        self.settled.len()
    }

    /// Number of colours.
    pub fn n_colors(&self) -> usize {
        self.settled.first().map_or(0, |filter| filter.n_colors())
    }

    /// The chain by which the light is switched.
    pub fn chain(&self) -> &MarkovChain {
        &self.chain
    }

    /// Predictions of all filters of the bank, each as if it were active.
    pub fn members(&self) -> &[Arc<LightingFilter>] {
        &self.predicted
    }

    /// One of [`members`](Self::members).
    ///
    /// # Panics
    /// Panics if there is no such member; see [`n_members`](Self::n_members).
    pub fn member(&self, member: usize) -> &LightingFilter {
        &self.predicted[member]
    }

    /// The filter that learned last; before the first image the likeliest.
    pub fn active(&self) -> usize {
        let initial = self.chain.initial();
        let likeliest =
            || (0..initial.len()).rev().max_by(|a, b| initial[*a].total_cmp(&initial[*b])).unwrap_or(0);
        self.active.unwrap_or_else(likeliest)
    }

    /// Probability that `member` is the active one now, given the one before.
    pub fn switch_probability(&self, member: usize) -> f64 {
        match self.active {
            Some(active) => self.chain.probability(active, member),
            None => self.chain.initial().get(member).copied().unwrap_or(0.0),
        }
    }

    /// Prepares every filter for being the active one after `seconds`.
    ///
    /// # Errors
    /// Returns an error if the time is negative or not finite; the state is then unchanged.
    pub fn predict(&mut self, seconds: f64) -> Result<(), ColorModelError> {
        let predict = |filter: &Arc<LightingFilter>| {
            let mut filter = LightingFilter::clone(filter);
            filter.predict(seconds)?;
            Ok::<_, ColorModelError>(Arc::new(filter))
        };
        self.predicted = self.predicted.iter().map(predict).collect::<Result<_, _>>()?;
        Ok(())
    }

    /// Sets `member` active and updates it with `means`; the others return to their stored state. Returns the log evidence, nats.
    /// # Errors
    /// Returns an error if there is no such member or it refuses the means; the state is then unchanged.
    pub fn update_member(&mut self, member: usize, means: &ColorMeans) -> Result<f64, ColorModelError> {
        let n_members = self.n_members();
        let filter = self.predicted.get(member).ok_or(ColorModelError::NoSuchMember { member, n_members })?;
        let mut filter = LightingFilter::clone(filter);
        let log_evidence = filter.update(means)?;
        self.settled[member] = Arc::new(filter);
        self.predicted = self.settled.clone();
        self.active = Some(member);
        Ok(log_evidence)
    }

    /// Draws the active member from the optimal proposal $`p(j | i, z) ∝ π_{ij}\, p(z | j)`$ by enumeration, given $`\ln p(z | j)`$ of a frame under
    /// each. It does not learn. [Andrieu et al. 2002]
    ///
    /// A frame that is impossible under every member keeps the active one and has log-likelihood $`-∞`$. One number is drawn in any case.
    /// # Errors
    /// Returns an error if there are not as many log-likelihoods as members, or one is NaN or $`+∞`$.
    pub fn choose<R: Rng + ?Sized>(
        &self,
        log_likelihoods: &[f64],
        rng: &mut R,
    ) -> Result<SelectedLightingFilter, ColorModelError> {
        let (expected, got) = (self.n_members(), log_likelihoods.len());
        if expected != got {
            return Err(ColorModelError::Dimension { what: "log-likelihoods of a bank", expected, got });
        }
        if log_likelihoods.iter().any(|l| l.is_nan() || *l == f64::INFINITY) {
            return Err(ColorModelError::NotFinite { what: "log-likelihood of a frame" });
        }
        let uniform: f64 = rng.random();
        let logs = || log_likelihoods.iter().enumerate().map(|(j, l)| self.switch_probability(j).ln() + l);
        let log_likelihood = log_sum_exp(&logs().collect::<Vec<_>>());
        let mut left = uniform;
        let drawn = logs().position(|log| {
            left -= (log - log_likelihood).exp();
            left < 0.0
        });
        // Rounding may leave a little; and shares of an impossible frame are NaN, which is never below.
        let last_possible = || logs().rposition(|log| log > f64::NEG_INFINITY);
        let member = drawn.or_else(last_possible).unwrap_or(self.active());
        Ok(SelectedLightingFilter { member, log_likelihood })
    }
}
