use std::collections::VecDeque;

use wayfix_estimation_traits::Pose2;

use super::belief::Belief;
use super::doubt::Doubt;
use super::fit::Fit;
use super::running_share::RunningShare;
use super::{AppearanceLocalizer, LocalizerParams, Proof};
use crate::{AppearanceError, Descriptor, OdometryNoise, ReferenceSearch, separation_squared};

/// Where the robot is thought to be against where else it may be: a second belief, begun from nothing when the first misses what it should see.
///
/// Both are moved by the same odometry and shown the same views, and neither knows of the other. A place that has changed is missed as well as one
/// where the robot is not, so that missing alone decides nothing. But a place that merely looks like another does so for as long as a
/// shelf is, and a robot that was carried goes on and on recognizing where it is.
#[derive(Clone, Debug, Default)]
pub(super) struct Contest {
    doubt: Doubt,
    /// Share of the last views for which nothing was known where the first is: 1 for who explores.
    exploring: RunningShare,
    /// Whether this doubt has seen a break, while the robot was not exploring: a view that is strange to the one before, over no more than a step.
    broken: bool,
    rival: Option<Rival>,
}

#[derive(Clone, Debug)]
struct Rival {
    belief: Belief,
    /// Since it has been at one place that odometry carries on.
    record: VecDeque<Round>,
}

/// One view.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Round {
    /// Since the view before, m.
    way: f64,
    first: Fit,
    rival: Fit,
}

/// Steps between two views up to which they look alike, unless there is a break.
const MOST_STEPS: f64 = 1.5;

/// Who explores more than this is not thought to be carried: there is nothing to recognize there, so that any aisle that looks alike would win.
const MOST_EXPLORING: f64 = 0.9;

impl Contest {
    /// After the robot has moved.
    pub(super) fn moved(
        &self,
        increment: &Pose2<f64>,
        noise: &OdometryNoise,
    ) -> Result<Self, AppearanceError> {
        let Some(rival) = &self.rival else { return Ok(self.clone()) };
        let rival = Rival { belief: rival.belief.moved(increment, noise)?, record: rival.record.clone() };
        Ok(Self { rival: Some(rival), ..*self })
    }

    /// Whether the rival recognizes more than the first does: until that is decided nothing should be learned.
    pub(super) fn is_open(&self) -> bool {
        let Some(rival) = &self.rival else { return false };
        let n = |side: fn(&Round) -> Fit| {
            rival.record.iter().filter(|round| side(round) == Fit::Recognized).count()
        };
        n(|round| round.rival) > n(|round| round.first)
    }

    /// The belief that is believed from now on: the rival's, when it has won.
    pub(super) fn decided(self, first: Belief, params: &LocalizerParams) -> (Self, Belief) {
        let proof = params.relocation.proof(self.broken);
        match self.rival {
            Some(rival)
                if rival.belief.one_place(&params.unimodal).is_some()
                    && rival.has_won(proof, params.relocation.by_chance) =>
            {
                (Self::default(), rival.belief)
            }
            _ => (self, first),
        }
    }
}

impl Rival {
    fn has_won(&self, proof: &Proof, by_chance: f64) -> bool {
        let way: f64 = self.record.iter().map(|round| round.way).sum();
        let share = |side: fn(&Round) -> Fit| {
            let n = self.record.iter().filter(|round| side(round) == Fit::Recognized).count();
            n as f64 / self.record.len().max(1) as f64
        };
        way >= proof.way
            && share(|round| round.rival) >= proof.recognized
            && share(|round| round.first) <= by_chance
    }
}

impl<D: Descriptor + Clone, S: ReferenceSearch<D>> AppearanceLocalizer<D, S> {
    /// The contest after a view; `first` is what the view makes of the first belief.
    pub(super) fn contested(&self, view: &D, first: &Belief) -> Result<Contest, AppearanceError> {
        let params = &self.params.relocation;
        if params.doubt >= 1.0 || first.state.is_none() {
            return Ok(Contest::default());
        }
        let fit = self.fit(view, &self.belief);
        let exploring = self.contest.exploring.after(fit == Fit::Unknown, params.views);
        let is_break = self.is_break(view);
        let doubt = if is_break { Doubt::great(params) } else { self.contest.doubt.after(fit, params) };
        if !doubt.is_great() {
            return Ok(Contest { doubt, exploring, ..Contest::default() });
        }
        let broken = self.contest.broken || is_break && self.contest.exploring.0 <= MOST_EXPLORING;
        let nowhere = Rival { belief: Belief::nowhere(), record: VecDeque::new() };
        let before = self.contest.rival.as_ref().filter(|_| !is_break).unwrap_or(&nowhere);
        let (belief, _) = self.seen(&before.belief, Some(view), &[])?;
        let mut record = before.record.clone();
        let round = Round {
            way: self.motion.increment.translation.norm(),
            first: fit,
            rival: self.fit(view, &before.belief),
        };
        record.push_back(round);
        if !self.goes_on(&before.belief, &belief)? {
            record.clear();
        }
        let least = params.proof(broken).way;
        let mut way: f64 = record.iter().map(|round| round.way).sum();
        while let Some(oldest) = record.front().filter(|oldest| way - oldest.way >= least) {
            way -= oldest.way;
            record.pop_front();
        }
        Ok(Contest { doubt, exploring, broken, rival: Some(Rival { belief, record }) })
    }

    /// Whether the view is as strange to the one before as one of a far place, although the wheels say that it is a step away. Who is carried sees it, or
    /// is blind meanwhile; who drives into an aisle that was rearranged does not.
    fn is_break(&self, view: &D) -> bool {
        let scale = self.map.scale();
        let is_near = self.motion.increment.translation.norm() <= MOST_STEPS * scale.step();
        let strange = |last: &D| view.compare(last).distance > scale.strangeness();
        is_near && self.last_seen.as_ref().is_some_and(strange)
    }

    /// Whether the heaviest hypothesis is the same as before the view.
    fn goes_on(&self, before: &Belief, after: &Belief) -> Result<bool, AppearanceError> {
        let (Some(before), Some(after)) = (before.heaviest(), after.heaviest()) else { return Ok(false) };
        Ok(separation_squared(before, after)? <= self.params.fusion.gate)
    }
}
