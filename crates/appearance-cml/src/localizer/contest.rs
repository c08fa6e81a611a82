use wayfix_estimation_traits::Pose2;

use super::belief::Belief;
use super::doubt::Doubt;
use super::fit::Fit;
use super::rival::{Rival, Round};
use super::running_share::RunningShare;
use super::{AppearanceLocalizer, LocalizerParams, Proof, RelocationParams};
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
    /// The last one that this doubt has seen.
    last_break: Option<Break>,
    /// Whether the last view was one.
    broke: bool,
    rival: Option<Rival>,
}

/// A view that is strange to the one before, over no more than a step.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Break {
    /// Way since then, m.
    way: f64,
    /// Whether nothing was known before it.
    exploring: bool,
    /// Whether the view before was as strange to the one before it. Who is carried sees one such step; at a corner or past the end of a shelf there may be
    /// several in a row.
    repeated: bool,
}

/// Steps between two views up to which they look alike, unless there is a break.
const MOST_STEPS: f64 = 1.5;

/// Who explores more than this may not have been carried: there is nothing to recognize there, so that any aisle that looks alike would win.
const MOST_EXPLORING: f64 = 0.9;

/// Way after a break within which whoever was put where something is known has recognized it, m: a few views.
const AT_ONCE_M: f64 = 1.0;

impl Contest {
    /// After the robot has moved.
    pub(super) fn moved(
        &self,
        increment: &Pose2<f64>,
        noise: &OdometryNoise,
    ) -> Result<Self, AppearanceError> {
        let Some(rival) = &self.rival else { return Ok(self.clone()) };
        let rival = rival.with(rival.belief.moved(increment, noise)?);
        Ok(Self { rival: Some(rival), ..*self })
    }

    /// Whether the rival recognizes more than the first does: until that is decided nothing should be learned.
    pub(super) fn is_open(&self) -> bool {
        self.rival.as_ref().is_some_and(Rival::leads)
    }

    fn recent_break(&self, params: &RelocationParams) -> Option<Break> {
        self.last_break.filter(|last| last.way <= params.break_way)
    }

    /// What a rival has to show that has been at one place for this way.
    fn proof(&self, rival_way: f64, params: &RelocationParams) -> Proof {
        match self.recent_break(params) {
            None => params.strayed,
            Some(last) if last.exploring || last.repeated || last.way - rival_way > AT_ONCE_M => {
                params.carried_unknown
            }
            Some(_) => params.carried,
        }
    }

    /// The belief that is believed from now on: the rival's, when it has won.
    pub(super) fn decided(self, first: Belief, params: &LocalizerParams) -> (Self, Belief) {
        let has_won = |rival: &Rival| {
            let proof = self.proof(rival.way, &params.relocation);
            rival.belief.one_place(&params.unimodal).is_some()
                && rival.has_won(&proof, params.relocation.by_chance)
        };
        match &self.rival {
            Some(rival) if has_won(rival) => (Self::default(), rival.belief.clone()),
            _ => (self, first),
        }
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
            return Ok(Contest { doubt, exploring, broke: is_break, ..Contest::default() });
        }
        let way = self.motion.increment.translation.norm();
        let last_break = if is_break {
            let exploring = self.contest.exploring.0 > MOST_EXPLORING;
            Some(Break { way: 0.0, exploring, repeated: self.contest.broke })
        } else {
            self.contest.last_break.map(|last| Break { way: last.way + way, ..last })
        };
        let contest = Contest { doubt, exploring, last_break, broke: is_break, rival: None };
        let is_of_lost = contest.recent_break(params).is_some_and(|last| !last.exploring);
        let nowhere = Rival::nowhere(is_of_lost);
        let before = self.contest.rival.as_ref().filter(|_| !is_break).unwrap_or(&nowhere);
        let (belief, _) = self.seen(&before.belief, Some(view), &[])?;
        let goes_on = self.goes_on(&before.belief, &belief)?;
        let round = Round { way, first: fit, rival: self.fit(view, &before.belief) };
        let mut rival = before.with(belief);
        if goes_on {
            rival.goes_on(round);
        } else {
            rival.is_elsewhere();
        }
        rival.shorten(contest.proof(rival.way, params).way);
        Ok(Contest { rival: Some(rival), ..contest })
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_was_carried_where_it_knows_its_way_at_once_has_least_to_show() {
        let params = RelocationParams::default();
        let proof = |last: Break, rival_way: f64| {
            Contest { last_break: Some(last), ..Contest::default() }.proof(rival_way, &params)
        };
        let plain = Break { way: 5.5, exploring: false, repeated: false };
        assert_eq!(proof(plain, 5.0), params.carried);
        assert_eq!(proof(Break { way: 7.0, ..plain }, 5.0), params.carried_unknown);
        assert_eq!(proof(Break { exploring: true, ..plain }, 5.0), params.carried_unknown);
        assert_eq!(proof(Break { repeated: true, ..plain }, 5.0), params.carried_unknown);
        assert_eq!(proof(Break { way: params.break_way + 0.1, ..plain }, 20.0), params.strayed);
        assert_eq!(Contest::default().proof(5.0, &params), params.strayed);
    }
}
