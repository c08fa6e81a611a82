use crate::KalmanError;

/// A first-order Markov chain over the models of a bank.
///
/// ```
/// use wayfix_kalman::MarkovChain;
/// // A light that stays as it is in 95 of 100 frames.
/// let chain = MarkovChain::new(&[vec![0.95, 0.05], vec![0.05, 0.95]], &[1.0, 0.0])?;
/// assert_eq!(chain.predict_probabilities(chain.initial()), [0.95, 0.05]);
/// # Ok::<(), wayfix_kalman::KalmanError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MarkovChain {
    transition: Vec<Vec<f64>>,
    initial: Vec<f64>,
}

impl MarkovChain {
    /// `transition[i][j]` = probability that model `j` follows model `i`; `initial` = probabilities of the models at the start.
    ///
    /// # Errors
    /// Returns an error if there are no models, sizes do not match, or a row (the initial one counts as the last) is not a probability
    /// distribution to nine digits.
    pub fn new(transition: &[Vec<f64>], initial: &[f64]) -> Result<Self, KalmanError> {
        crate::check::dimension("transition matrix", initial.len(), transition.len())?;
        if initial.is_empty() {
            return Err(KalmanError::EmptyBank);
        }
        for (row, probabilities) in transition.iter().map(Vec::as_slice).chain([initial]).enumerate() {
            crate::check::dimension("transition matrix", initial.len(), probabilities.len())?;
            let sum: f64 = probabilities.iter().sum();
            let each = probabilities.iter().all(|p| (0.0..=1.0).contains(p));
            if !each || (sum - 1.0).abs() > 1e-9 {
                return Err(KalmanError::NotStochastic { row, sum });
            }
        }
        Ok(Self { transition: transition.to_vec(), initial: initial.to_vec() })
    }

    /// `n_models` models, each of which stays active with probability `stay` and else changes to any other; all equally probable at the start.
    ///
    /// # Errors
    /// Returns an error if `stay` is not a probability or there are no models.
    pub fn sticky(n_models: usize, stay: f64) -> Result<Self, KalmanError> {
        if !(0.0..=1.0).contains(&stay) {
            return Err(KalmanError::OutOfRange { what: "probability of staying", value: stay });
        }
        let leave = (1.0 - stay) / n_models.saturating_sub(1).max(1) as f64;
        let stay = if n_models == 1 { 1.0 } else { stay };
        let row = |i| (0..n_models).map(|j| if i == j { stay } else { leave }).collect();
        let transition: Vec<Vec<f64>> = (0..n_models).map(row).collect();
        Self::new(&transition, &vec![1.0 / n_models.max(1) as f64; n_models])
    }

    /// How many models.
    pub fn n_models(&self) -> usize {
        self.initial.len()
    }
    /// Probabilities at the start.
    pub fn initial(&self) -> &[f64] {
        &self.initial
    }
    /// Probability that model `to` follows model `from`; 0 for models that are not there.
    pub fn probability(&self, from: usize, to: usize) -> f64 {
        self.transition.get(from).and_then(|row| row.get(to)).copied().unwrap_or(0.0)
    }
    /// Probabilities after a step, from those before: $`\bar μ_j = \sum_i μ_i π_{ij}`$.
    pub fn predict_probabilities(&self, probabilities: &[f64]) -> Vec<f64> {
        (0..self.n_models())
            .map(|to| probabilities.iter().enumerate().map(|(from, p)| p * self.probability(from, to)).sum())
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_are_no_distributions_are_refused() {
        let half = vec![0.5, 0.5];
        for bad in [vec![0.5, 0.6], vec![1.5, -0.5], vec![f64::NAN, 1.0]] {
            assert!(matches!(
                MarkovChain::new(&[half.clone(), bad.clone()], &half),
                Err(KalmanError::NotStochastic { row: 1, .. })
            ));
            assert!(matches!(
                MarkovChain::new(&[half.clone(), half.clone()], &bad),
                Err(KalmanError::NotStochastic { row: 2, .. })
            ));
        }
        assert!(MarkovChain::new(std::slice::from_ref(&half), &half).is_err());
        assert_eq!(MarkovChain::new(&[], &[]), Err(KalmanError::EmptyBank));
        assert!(MarkovChain::sticky(0, 0.5).is_err() && MarkovChain::sticky(2, f64::NAN).is_err());
        assert_eq!(MarkovChain::sticky(1, 0.9).unwrap().probability(0, 0), 1.0);
    }
}
