use std::collections::VecDeque;

use super::Proof;
use super::belief::{Belief, Outlook};
use super::fit::Fit;

/// Where else the robot may be, and how that has done against where it is thought to be.
#[derive(Clone, Debug)]
pub(super) struct Rival {
    pub(super) belief: Belief,
    /// Since it has been at one place that odometry carries on, as far back as the proof goes.
    record: VecDeque<Round>,
    /// Way since then, m.
    pub(super) way: f64,
}

/// One view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Round {
    /// Since the view before, m.
    pub(super) way: f64,
    pub(super) first: Fit,
    pub(super) rival: Fit,
}

impl Rival {
    /// Begun from nothing.
    pub(super) fn nowhere(outlook: Outlook) -> Self {
        Self { belief: Belief::nowhere(outlook), record: VecDeque::new(), way: 0.0 }
    }

    /// A belief that another has taken over from: one place, which looks for nothing but what it expects, lest it follow the other.
    pub(super) fn ousted(belief: &Belief) -> Self {
        Self { belief: belief.heaviest_alone(), record: VecDeque::new(), way: 0.0 }
    }

    /// The same against another first belief, to which what it has shown against the one before says nothing.
    pub(super) fn against_another(self) -> Self {
        Self { record: VecDeque::new(), ..self }
    }

    /// What one that was ousted is when it is believed again.
    pub(super) fn reinstated(&self) -> Belief {
        Belief { outlook: Outlook::Map, ..self.belief.clone() }
    }

    pub(super) fn with(&self, belief: Belief) -> Self {
        Self { belief, record: self.record.clone(), way: self.way }
    }

    /// It is where it was, moved on.
    pub(super) fn goes_on(&mut self, round: Round) {
        self.way += round.way;
        self.record.push_back(round);
    }

    pub(super) fn is_elsewhere(&mut self) {
        (self.way, self.record) = (0.0, VecDeque::new());
    }

    /// Forgets what no proof goes back to.
    pub(super) fn shorten(&mut self, least: f64) {
        let mut way = self.recorded_way();
        while let Some(oldest) = self.record.front().filter(|oldest| way - oldest.way >= least) {
            way -= oldest.way;
            self.record.pop_front();
        }
    }

    /// Whether it recognizes more than the first does.
    pub(super) fn leads(&self) -> bool {
        self.n_recognized(|round| round.rival) > self.n_recognized(|round| round.first)
    }

    pub(super) fn has_won(&self, proof: &Proof, by_chance: f64) -> bool {
        let share = |side| self.n_recognized(side) as f64 / self.record.len().max(1) as f64;
        self.recorded_way() >= proof.way
            && share(|round| round.rival) >= proof.recognized
            && share(|round| round.first) <= by_chance
    }

    fn n_recognized(&self, side: fn(&Round) -> Fit) -> usize {
        self.record.iter().filter(|round| side(round) == Fit::Recognized).count()
    }

    fn recorded_way(&self) -> f64 {
        self.record.iter().map(|round| round.way).sum()
    }
}
