use crate::{
    RelocalizationParams,
    change_test::times,
    error::{IntegrityError, check, check_distance, check_ratio},
};

/// A place that a global search proposes.
///
/// ```
/// use wayfix_integrity::{RelocalizationCandidate, RelocalizationParams, RelocalizationTest};
/// let mut test = RelocalizationTest::new(RelocalizationParams::default())?;
/// let hall = RelocalizationCandidate { hypothesis: "hall", prior: 0.01, log_likelihood_ratio: 50.0 };
/// test.propose([hall])?;
/// assert!((test.probability() - 0.5).abs() < 1e-12); // even odds at most, whatever the ratio
/// assert!(test.propose([RelocalizationCandidate { prior: 0.0, ..hall }]).is_err());
/// # Ok::<(), wayfix_integrity::IntegrityError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelocalizationCandidate<H> {
    /// The hypothesis: a pose, a mixture component, a particle set.
    pub hypothesis: H,
    /// Prior probability that a moved robot is there, above 0: one over the number of distinguishable places.
    pub prior: f64,
    /// Log-likelihood ratio of the measurements of the search, against the present hypothesis, in nats.
    pub log_likelihood_ratio: f64,
}

/// An alternative to the present hypothesis.
///
/// ```
/// use wayfix_integrity::{RelocalizationCandidate, RelocalizationParams, RelocalizationTest};
/// let mut test = RelocalizationTest::new(RelocalizationParams::default())?;
/// test.drive(10.0)?; // m since the last search
/// test.propose([RelocalizationCandidate { hypothesis: "hall", prior: 0.01, log_likelihood_ratio: 3.0 }])?;
/// let alternative = test.alternatives()[0];
/// assert!((alternative.statistic() - 0.01 * 10.0 * 3_f64.exp()).abs() < 1e-12); // prior, distance, likelihood ratio
/// assert!(!alternative.is_previous());
/// # Ok::<(), wayfix_integrity::IntegrityError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlternativeHypothesis<H> {
    /// The hypothesis.
    pub hypothesis: H,
    /// Its Shiryaev–Roberts statistic, m.
    statistic: f64,
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// As probable as the present hypothesis before any measurement.
    Start,
    /// Of a search; removed below this statistic, m.
    Proposed { removed_below: f64 },
    /// It was the present hypothesis; the distance driven since, m.
    Previous { distance: f64 },
}

/// Relocalization as a sequential test between the present hypothesis and alternatives. [Shiryaev 1963; Pollak 1985]
///
/// An alternative $`j`$ with prior $`π_j`$ starts at $`R_j = π_j\, d\, Λ_j`$, where $`d`$ is the distance since the last search (at least 1 m) and
/// $`Λ_j`$ the likelihood ratio of its measurements. These have selected the alternative, so they can make the odds of all
/// proposals together, $`p \sum_j R_j`$, even and no more. Each measurement multiplies $`R_j`$ by its likelihood ratio. The robot has been moved when the
/// largest statistic reaches $`A`$: the mean distance to a false alarm is at least $`A`$ if $`\sum_j π_j ≤ 1`$ and the ratios are those of independent measurements. (Ratios
/// that a search has maximized over more than the place are larger.)
///
/// At an unknown start all places are equally probable ([`start`](Self::start)): an alternative with the likelihood ratio $`Λ_j`$ has the odds
/// $`p R_j = Λ_j`$ and replaces the present hypothesis when they reach 1.
///
/// Otherwise the replaced hypothesis remains an alternative for a distance, with the odds that it has: $`p R = (p R_j)^{-1}`$.
/// An alternative of a search or of an unknown start is removed when its odds have fallen by the factor $`p A`$, the odds of a decision.
///
/// ```
/// use wayfix_integrity::{RelocalizationCandidate, RelocalizationTest, RelocalizationParams};
/// let mut present = 0.0; // m along a corridor of 100 m
/// let mut relocalization = RelocalizationTest::new(RelocalizationParams::default())?;
/// relocalization.propose([RelocalizationCandidate { hypothesis: 40.0, prior: 0.01, log_likelihood_ratio: 3.0 }])?;
/// for (measured, is_decided) in [(40.1, false), (39.8, false), (40.3, true)] {
///     let log_likelihood = |x: &f64| -0.5 * f64::min((measured - x).powi(2), 10.0);
///     relocalization.observe(log_likelihood(&present), |x| log_likelihood(x))?;
///     assert_eq!(relocalization.decide(&mut present), is_decided);
/// }
/// assert_eq!(present, 40.0);
/// assert_eq!(relocalization.alternatives()[0].hypothesis, 0.0); // kept for 20 m
/// # Ok::<(), wayfix_integrity::IntegrityError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RelocalizationTest<H> {
    params: RelocalizationParams,
    alternatives: Vec<AlternativeHypothesis<H>>,
    /// Distance since the last search, m.
    distance: f64,
}

/// A search counts as at least this distance, m: a standing robot can be moved too.
const MIN_DISTANCE: f64 = 1.0;

impl<H> RelocalizationTest<H> {
    /// No alternatives.
    ///
    /// # Errors
    /// Returns an error if a parameter is out of range.
    pub fn new(params: RelocalizationParams) -> Result<Self, IntegrityError> {
        params.validate()?;
        Ok(Self { params, alternatives: Vec::new(), distance: 0.0 })
    }

    /// The alternatives, in the order of their arrival.
    pub fn alternatives(&self) -> &[AlternativeHypothesis<H>] {
        &self.alternatives
    }
    /// The same, to move their hypotheses with the robot.
    pub fn alternatives_mut(&mut self) -> &mut [AlternativeHypothesis<H>] {
        &mut self.alternatives
    }
    /// Removes each alternative that has become the same as the present hypothesis, or as an alternative with a larger statistic. The previous hypothesis
    /// stays for its distance.
    pub fn remove_duplicates(&mut self, present: &H, is_same: impl Fn(&H, &H) -> bool) {
        let is_previous = |at: &usize| self.alternatives[*at].is_previous();
        let mut by_statistic: Vec<usize> =
            (0..self.alternatives.len()).filter(|at| !is_previous(at)).collect();
        let statistic = |at: &usize| self.alternatives[*at].statistic;
        by_statistic.sort_by(|a, b| statistic(b).total_cmp(&statistic(a)));
        let mut kept: Vec<usize> = Vec::new();
        for at in by_statistic {
            let hypothesis = &self.alternatives[at].hypothesis;
            let others = kept.iter().map(|other| &self.alternatives[*other].hypothesis);
            if !others.chain([present]).any(|other| is_same(other, hypothesis)) {
                kept.push(at);
            }
        }
        let mut at = 0..;
        self.alternatives.retain(|alternative| {
            let is_kept = at.next().is_some_and(|at| kept.contains(&at));
            is_kept || alternative.is_previous()
        });
    }
    /// Posterior probability that the robot is at one of the alternatives.
    pub fn probability(&self) -> f64 {
        let statistics = self.alternatives.iter().map(AlternativeHypothesis::statistic);
        self.params.probability(statistics.fold(0.0, |sum, one| sum + one))
    }

    /// Adds driven distance, in m.
    ///
    /// # Errors
    /// Returns an error if the distance is negative or not finite.
    pub fn drive(&mut self, distance: f64) -> Result<(), IntegrityError> {
        check_distance(distance)?;
        self.distance += distance;
        let alternative_kept_distance = self.params.alternative_kept_distance;
        self.alternatives.retain_mut(|alternative| match &mut alternative.kind {
            Kind::Previous { distance: since } => {
                *since += distance;
                *since <= alternative_kept_distance
            }
            Kind::Proposed { .. } | Kind::Start => true,
        });
        Ok(())
    }

    /// Adds the result of a global search.
    ///
    /// # Errors
    /// Returns an error if a prior is not in (0, 1], or a ratio is NaN; no proposal is added then.
    pub fn propose(
        &mut self,
        proposals: impl IntoIterator<Item = RelocalizationCandidate<H>>,
    ) -> Result<(), IntegrityError> {
        let (distance, even) = (self.search_distance(), 1.0 / self.params.prior());
        let removal_factor = self.removal_factor();
        let start = |RelocalizationCandidate { hypothesis, prior, log_likelihood_ratio }| {
            check("prior", prior, prior > 0.0 && prior <= 1.0, "above 0, at most 1")?;
            check_ratio(log_likelihood_ratio)?;
            let statistic = times(prior * distance, log_likelihood_ratio);
            let removed_below = removal_factor * prior * distance;
            Ok(AlternativeHypothesis { hypothesis, statistic, kind: Kind::Proposed { removed_below } })
        };
        let mut started = proposals.into_iter().map(start).collect::<Result<Vec<_>, IntegrityError>>()?;
        let total: f64 = started.iter().map(|one| one.statistic / even).sum();
        started.iter_mut().for_each(|one| one.statistic /= total.max(1.0));
        self.alternatives.extend(started);
        self.distance = 0.0;
        self.remove_hopeless();
        Ok(())
    }

    /// Replaces all alternatives: the start is unknown, and each of these hypotheses was as probable as the present one before the measurements.
    /// Each comes with the log-likelihood ratio of its measurements against the present hypothesis, in nats.
    ///
    /// # Errors
    /// Returns an error if a ratio is NaN; the alternatives are unchanged then.
    pub fn start(&mut self, hypotheses: impl IntoIterator<Item = (H, f64)>) -> Result<(), IntegrityError> {
        let even = 1.0 / self.params.prior();
        let start = |(hypothesis, log_likelihood_ratio)| {
            check_ratio(log_likelihood_ratio)?;
            Ok(AlternativeHypothesis {
                hypothesis,
                statistic: times(even, log_likelihood_ratio),
                kind: Kind::Start,
            })
        };
        self.alternatives = hypotheses.into_iter().map(start).collect::<Result<Vec<_>, IntegrityError>>()?;
        self.distance = 0.0;
        self.remove_hopeless();
        Ok(())
    }

    /// Takes a measurement: its log-likelihood under the present hypothesis and under each alternative, in nats.
    ///
    /// # Errors
    /// Returns an error if a log-likelihood is NaN, or infinite under both; the statistics are unchanged then.
    pub fn observe(
        &mut self,
        present: f64,
        mut log_likelihood: impl FnMut(&mut H) -> f64,
    ) -> Result<(), IntegrityError> {
        let ratios = self.alternatives.iter_mut().map(|a| log_likelihood(&mut a.hypothesis) - present);
        let ratios = ratios.map(|ratio| check_ratio(ratio).map(|()| ratio));
        let ratios = ratios.collect::<Result<Vec<f64>, _>>()?;
        for (alternative, ratio) in self.alternatives.iter_mut().zip(ratios) {
            alternative.statistic = times(alternative.statistic, ratio);
        }
        self.remove_hopeless();
        Ok(())
    }

    /// Replaces `present` by the best alternative if its statistic reaches the threshold. Returns whether it did.
    pub fn decide(&mut self, present: &mut H) -> bool {
        let won =
            self.alternatives.iter().enumerate().filter(|(_, one)| one.statistic >= self.threshold(one.kind));
        let Some((index, _)) = won.max_by(|a, b| a.1.statistic.total_cmp(&b.1.statistic)) else {
            return false;
        };
        let best = self.alternatives.remove(index);
        // Odds against the present hypothesis become odds against the one that replaces it.
        let prior = self.params.prior();
        for rival in &mut self.alternatives {
            rival.statistic /= prior * best.statistic;
        }
        let previous = AlternativeHypothesis {
            hypothesis: std::mem::replace(present, best.hypothesis),
            statistic: 1.0 / (prior * prior * best.statistic),
            kind: if best.kind == Kind::Start { Kind::Start } else { Kind::Previous { distance: 0.0 } },
        };
        self.alternatives.push(previous);
        true
    }

    /// The statistic at which an alternative replaces the present hypothesis.
    fn threshold(&self, kind: Kind) -> f64 {
        if kind == Kind::Start { 1.0 / self.params.prior() } else { self.params.threshold() }
    }

    fn search_distance(&self) -> f64 {
        self.distance.max(MIN_DISTANCE)
    }

    /// Removes each alternative whose odds have fallen, from where it started, by the factor at which an even alternative would be decided.
    fn remove_hopeless(&mut self) {
        let start = self.removal_factor() / self.params.prior();
        self.alternatives.retain(|alternative| match alternative.kind {
            Kind::Start => alternative.statistic >= start,
            Kind::Proposed { removed_below } => alternative.statistic >= removed_below,
            Kind::Previous { .. } => true,
        });
    }

    /// $`1/(pA)`$, the inverse of the odds of a decision; that of the default parameters if relocalization is off.
    fn removal_factor(&self) -> f64 {
        let params = if self.params.is_off() { RelocalizationParams::default() } else { self.params };
        1.0 / (params.prior() * params.threshold())
    }
}

impl<H> AlternativeHypothesis<H> {
    /// The Shiryaev–Roberts statistic, m.
    pub fn statistic(&self) -> f64 {
        self.statistic
    }
    /// Whether it was the present hypothesis before, and not one of an unknown start.
    pub fn is_previous(&self) -> bool {
        matches!(self.kind, Kind::Previous { .. })
    }
}
