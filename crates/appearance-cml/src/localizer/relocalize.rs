use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;
use wayfix_integrity::{RelocalizationCandidate, RelocalizationTest};

use super::belief::Belief;
use super::{AppearanceLocalizer, LocalizerParams};
use crate::model::{N_FAR, PlaceTest};
use crate::{AppearanceMap, AppearanceMapError, ReferenceSearch, ViewDescriptor, separation_squared};

/// Is the robot where the belief puts it? The test between the belief and alternatives from searches of the whole map.
///
/// A view *recognizes* a hypothesis if a reference there is nearer to it than all of [`N_FAR`] references of far places. At a wrong hypothesis
/// $`k`$ references do so with probability $`k/(k+n)`$, by exchangeability. At the right one the rate is the mean of a Beta posterior over the views so
/// far, from the uniform prior; a view counts with the probability that the robot is at no alternative. The log-likelihood ratio is that of
/// these two Bernoulli distributions, 0 where the map has no places.
///
/// A view that does not recognize the present hypothesis starts a search of the whole map, unless the last one was within the match radius.
///
/// Views nearer to one another than the match radius show the same things. Each counts as the share of an independent one that the
/// distance is of the match radius.
#[derive(Clone, Debug)]
pub(super) struct KidnapTest {
    alternatives: RelocalizationTest<Belief>,
    recognized: f64,
    missed: f64,
    /// Distance since the last search, m.
    unsearched: f64,
}

impl KidnapTest {
    pub(super) fn new(params: &LocalizerParams) -> Result<Self, AppearanceMapError> {
        Ok(Self {
            alternatives: RelocalizationTest::new(params.relocalization)?,
            recognized: 1.0,
            missed: 1.0,
            unsearched: f64::INFINITY,
        })
    }

    /// Posterior probability that the robot is at an alternative.
    pub(super) fn probability(&self) -> f64 {
        self.alternatives.probability()
    }

    /// Whether the hypothesis before the last relocalization may still return.
    pub(super) fn keeps_previous(&self) -> bool {
        self.alternatives.alternatives().iter().any(|alternative| alternative.is_previous())
    }

    /// Moves the alternatives by `predict`; one that fails stays behind and loses.
    pub(super) fn predict(&mut self, predict: impl Fn(&Belief) -> Result<Belief, AppearanceMapError>) {
        for alternative in self.alternatives.alternatives_mut() {
            if let Ok(moved) = predict(&alternative.hypothesis) {
                alternative.hypothesis = moved;
            }
        }
    }

    /// Mean of the Beta posterior of the probability that a view recognizes the place of the robot.
    fn rate(&self) -> f64 {
        self.recognized / (self.recognized + self.missed)
    }

    /// Takes the test of the present hypothesis, as a share of an independent view.
    fn observe(&mut self, test: Option<PlaceTest>, independence: f64) {
        let counted = independence * (1.0 - self.probability());
        match test {
            Some(test) if test.is_recognized => self.recognized += counted,
            Some(_) => self.missed += counted,
            None => {}
        }
    }
}

/// Log-likelihood ratio of a view between "the robot is there" and "the robot is elsewhere".
fn log_ratio(test: Option<PlaceTest>, rate: f64) -> f64 {
    let Some(PlaceTest { is_recognized, chance }) = test else { return 0.0 };
    // The right place is not recognized less often than a wrong one.
    let rate = rate.max(chance);
    if is_recognized { (rate / chance).ln() } else { ((1.0 - rate) / (1.0 - chance)).ln() }
}

impl<D: ViewDescriptor + Clone, S: ReferenceSearch<D>, M> AppearanceLocalizer<D, S, M> {
    /// Tests the present hypothesis with the view, and replaces `belief`, the present one after the view, if an alternative is accepted.
    ///
    /// Returns whether it did. `kidnap` is the test of the present hypothesis.
    pub(super) fn relocalize(
        &self,
        view: &D,
        kidnap: &mut KidnapTest,
        belief: &mut Belief,
    ) -> Result<bool, AppearanceMapError> {
        let is_on = !self.params.relocalization.is_off();
        let Some(present) = self.belief.heaviest().filter(|_| is_on) else { return Ok(false) };
        let (map, params) = (&self.map, &self.params);
        let distance = self.motion.distance();
        let radius = map.match_radius(&params.map);
        let independence = if radius > 0.0 { (distance / radius).min(1.0) } else { 0.0 };
        let sample = map.sample(view, self.n_views, N_FAR);
        let rate = kidnap.rate();
        let ratio = |test| independence * log_ratio(test, rate);
        let test = |at: Option<&Gaussian<Pose2<f64>>>| map.test_place(view, at?, &sample, &params.map);
        let of_present = test(Some(present));
        kidnap.unsearched += distance;
        kidnap.alternatives.drive(distance)?;
        kidnap.alternatives.observe(ratio(of_present), |alternative| ratio(test(alternative.heaviest())))?;
        for alternative in kidnap.alternatives.alternatives_mut() {
            // A hypothesis that becomes singular stays as it is and loses.
            if let Ok(seen) = seen(map, view, &alternative.hypothesis, params) {
                alternative.hypothesis = seen;
            }
        }
        kidnap.alternatives.remove_duplicates(belief, |one, other| {
            one.heaviest().zip(other.heaviest()).is_some_and(|(one, other)| is_same(one, other, params))
        });
        kidnap.observe(of_present, independence);
        let is_recognized = of_present.is_some_and(|test| test.is_recognized);
        if !is_recognized && kidnap.unsearched >= radius {
            let against_present = |place: &_| ratio(test(Some(place))) - ratio(of_present);
            self.propose_places(view, kidnap, (present, radius), against_present)?;
        }
        Ok(kidnap.alternatives.decide(belief))
    }

    /// Searches the map for a view and proposes the places that are not known yet, with their log-likelihood ratios against the present hypothesis.
    fn propose_places(
        &self,
        view: &D,
        kidnap: &mut KidnapTest,
        (present, radius): (&Gaussian<Pose2<f64>>, f64),
        against_present: impl Fn(&Gaussian<Pose2<f64>>) -> f64,
    ) -> Result<(), AppearanceMapError> {
        let (map, params) = (&self.map, &self.params);
        let prior = (radius * radius / map.area()).min(1.0);
        let mut places = search(map, view, params).unwrap_or_default();
        places.retain(|place| is_new(place, present, kidnap, map, params));
        let proposals = places.into_iter().filter_map(|place| {
            let log_likelihood_ratio = against_present(&place);
            Some(RelocalizationCandidate { hypothesis: Belief::at(place).ok()?, prior, log_likelihood_ratio })
        });
        kidnap.alternatives.propose(proposals)?;
        kidnap.unsearched = 0.0;
        Ok(())
    }
}

/// A hypothesis after the view, which is searched for near it.
fn seen<D: ViewDescriptor, S: ReferenceSearch<D>>(
    map: &AppearanceMap<D, S>,
    view: &D,
    belief: &Belief,
    params: &LocalizerParams,
) -> Result<Belief, AppearanceMapError> {
    let matched = map.match_view(view, belief, params)?;
    belief.fused(Some(&matched.likelihood), &[], map.area(), params)
}

/// The places of the whole map that match the view.
fn search<D: ViewDescriptor, S: ReferenceSearch<D>>(
    map: &AppearanceMap<D, S>,
    view: &D,
    params: &LocalizerParams,
) -> Result<Vec<Gaussian<Pose2<f64>>>, AppearanceMapError> {
    let anywhere = Belief { state: None, uniform: 1.0 };
    let peaks = map.match_view(view, &anywhere, params)?.likelihood.peaks;
    Ok(peaks.into_iter().map(|peak| peak.gaussian).collect())
}

/// Whether a place is far from the present hypothesis, and no alternative means it yet. Views of places that are not far from one another
/// are similar, so that both hypotheses would be recognized.
fn is_new<D: ViewDescriptor, S: ReferenceSearch<D>>(
    place: &Gaussian<Pose2<f64>>,
    present: &Gaussian<Pose2<f64>>,
    kidnap: &KidnapTest,
    map: &AppearanceMap<D, S>,
    params: &LocalizerParams,
) -> bool {
    let distance = (place.mean().translation - present.mean().translation).norm();
    let mut others =
        kidnap.alternatives.alternatives().iter().filter_map(|other| other.hypothesis.heaviest());
    distance > map.scale().far_distance() && !others.any(|other| is_same(other, place, params))
}

/// Whether two hypotheses mean one place.
fn is_same(one: &Gaussian<Pose2<f64>>, other: &Gaussian<Pose2<f64>>, params: &LocalizerParams) -> bool {
    separation_squared(one, other).is_ok_and(|squared| squared < params.fusion.gate)
}
