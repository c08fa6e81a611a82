use std::sync::Arc;

use wayfix_kalman::MarkovChain;

use super::{ColorMeans, LightingFilter};
use crate::ColorModelError;

/// Lighting filters for different kinds of light (dark, bright), of which one is active at a time; a Markov chain says how the light is switched.
///
/// Only the active filter learns; the others keep what they knew when they were last active. [Schulz & Fox 2004, §III.A.3] Which one is
/// active, a particle filter decides by drawing an index for each particle. Clones share their filters until one of them learns.
#[derive(Clone, Debug)]
pub struct LightingBank {
    chain: Arc<MarkovChain>,
    settled: Vec<Arc<LightingFilter>>,
    predicted: Vec<Arc<LightingFilter>>,
    active: Option<usize>,
}

impl LightingBank {
    /// A bank of filters for the same colours.
    ///
    /// # Errors
    /// When there are none, not as many as the chain has states, or they differ in their number of colours.
    pub fn new(filters: Vec<LightingFilter>, chain: MarkovChain) -> Result<Self, ColorModelError> {
        let (expected, got) = (chain.n_models(), filters.len());
        if expected != got {
            return Err(ColorModelError::Dimension { what: "lighting filters of a chain", expected, got });
        }
        let n_colors = filters.first().map_or(0, LightingFilter::n_colors);
        if let Some(other) = filters.iter().map(LightingFilter::n_colors).find(|n| *n != n_colors) {
            return Err(ColorModelError::Dimension {
                what: "colours of a filter",
                expected: n_colors,
                got: other,
            });
        }
        let settled: Vec<_> = filters.into_iter().map(Arc::new).collect();
        Ok(Self { chain: Arc::new(chain), predicted: settled.clone(), settled, active: None })
    }

    /// How many filters.
    pub fn n_members(&self) -> usize {
        self.settled.len()
    }

    /// How many colours.
    pub fn n_colors(&self) -> usize {
        self.settled.first().map_or(0, |filter| filter.n_colors())
    }

    /// What a filter of the bank predicts, should it be the active one now.
    ///
    /// # Panics
    /// When there is no such member; [`n_members`](Self::n_members) tells.
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
    /// When the time is negative or not finite; nothing has changed then.
    pub fn predict(&mut self, seconds: f64) -> Result<(), ColorModelError> {
        let predict = |filter: &Arc<LightingFilter>| {
            let mut filter = LightingFilter::clone(filter);
            filter.predict(seconds)?;
            Ok::<_, ColorModelError>(Arc::new(filter))
        };
        self.predicted = self.predicted.iter().map(predict).collect::<Result<_, _>>()?;
        Ok(())
    }

    /// `member` was the active one and saw `means`; the others fall back to what they knew. Gives the log evidence, nats.
    ///
    /// # Errors
    /// When there is no such member or it refuses the means; nothing has changed then.
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
}
