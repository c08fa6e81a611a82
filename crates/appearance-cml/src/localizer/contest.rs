use wayfix_estimation_traits::Pose2;

use super::belief::{Belief, Outlook};
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
///
/// When the second has taken over, the first goes along for a while as the one that was *ousted*: an aisle that looks like another ends, and if it is the
/// first that recognizes what comes then, it is believed again.
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
    ousted: Option<Rival>,
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
        let moved =
            |rival: &Rival| Ok::<_, AppearanceError>(rival.with(rival.belief.moved(increment, noise)?));
        let rival = self.rival.as_ref().map(moved).transpose()?;
        let ousted = self.ousted.as_ref().map(moved).transpose()?;
        Ok(Self { rival, ousted, ..*self })
    }

    /// Whether the rival recognizes more than the first does, or has just taken over: until that is decided nothing should be learned.
    pub(super) fn is_open(&self) -> bool {
        self.ousted.is_some() || self.rival.as_ref().is_some_and(Rival::leads)
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

    /// The belief that is believed from now on: the rival's, or that of the one that was ousted, when it has won.
    pub(super) fn decided(self, first: Belief, params: &LocalizerParams) -> (Self, Belief) {
        let has_won = |rival: &&Rival, proof: &Proof| {
            rival.belief.one_place(&params.unimodal).is_some()
                && rival.has_won(proof, params.relocation.by_chance)
        };
        let reinstated = &params.relocation.reinstated;
        if let Some(ousted) = self.ousted.as_ref().filter(|ousted| has_won(ousted, reinstated)) {
            return (Self::default(), ousted.reinstated());
        }
        let proven = |rival: &&Rival| has_won(rival, &self.proof(rival.way, &params.relocation));
        match self.rival.as_ref().filter(proven) {
            Some(rival) => {
                let belief = rival.belief.clone();
                // One that was ousted before has been believed for longer.
                let ousted = self.ousted.or(Some(Rival::ousted(first)));
                (Self { ousted, ..Self::default() }, belief)
            }
            None => (self, first),
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
        let way = self.motion.increment.translation.norm();
        let ousted = self.ousted_after(view, way, fit)?;
        if !doubt.is_great() {
            return Ok(Contest { doubt, exploring, broke: is_break, ousted, ..Contest::default() });
        }
        let last_break = if is_break {
            let exploring = self.contest.exploring.0 > MOST_EXPLORING;
            Some(Break { way: 0.0, exploring, repeated: self.contest.broke })
        } else {
            self.contest.last_break.map(|last| Break { way: last.way + way, ..last })
        };
        let contest = Contest { doubt, exploring, last_break, broke: is_break, rival: None, ousted };
        let is_of_lost = contest.recent_break(params).is_some_and(|last| !last.exploring);
        let nowhere = Rival::nowhere(if is_of_lost { Outlook::Lost } else { Outlook::Map });
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

    /// The one that was ousted after the view; `None` when it has gone along for long enough.
    fn ousted_after(&self, view: &D, way: f64, first: Fit) -> Result<Option<Rival>, AppearanceError> {
        let params = &self.params.relocation;
        let Some(before) = self.contest.ousted.as_ref().filter(|ousted| ousted.way < params.ousted_way)
        else {
            return Ok(None);
        };
        let (belief, _) = self.seen(&before.belief, Some(view), &[])?;
        let mut ousted = before.with(belief);
        ousted.goes_on(Round { way, first, rival: self.fit(view, &before.belief) });
        ousted.shorten(params.reinstated.way);
        Ok(Some(ousted))
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
    use wayfix_gaussian_core::Gaussian;

    use super::*;
    use crate::Start;

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

    #[test]
    fn who_was_ousted_goes_along_and_is_believed_again_when_it_alone_recognizes() {
        let params = LocalizerParams::default();
        let at = |x: f64| {
            let pose = Pose2::new(x, 0.0, 0.0);
            let known = Gaussian::from_sigmas(pose, &nalgebra::Vector3::new(0.1, 0.1, 0.02));
            Belief::of_start(Start::Known(known.expect("sigmas are positive"))).expect("a finite start")
        };
        let x = |belief: &Belief| belief.heaviest().map_or(f64::NAN, |pose| pose.mean().x());
        let seen = |rival: &mut Rival, fits: (Fit, Fit), n: usize| {
            (0..n).for_each(|_| rival.goes_on(Round { way: 0.5, first: fits.0, rival: fits.1 }));
        };
        let mut rival = Rival::nowhere(Outlook::Map).with(at(40.0));
        seen(&mut rival, (Fit::Missed, Fit::Recognized), 50);
        let contest = Contest { rival: Some(rival), ..Contest::default() };
        let (mut contest, first) = contest.decided(at(0.0), &params);
        assert!(x(&first) == 40.0 && contest.is_open() && contest.rival.is_none());

        let mut ousted = contest.ousted.clone().expect("the first goes along");
        assert!(x(&ousted.belief) == 0.0 && ousted.belief.outlook == Outlook::Nearby);
        // While both recognize something it stays as it is.
        seen(&mut ousted, (Fit::Recognized, Fit::Recognized), 10);
        contest.ousted = Some(ousted);
        let (mut contest, first) = contest.decided(first, &params);
        assert_eq!(x(&first), 40.0);

        let mut ousted = contest.ousted.clone().expect("it still goes along");
        seen(&mut ousted, (Fit::Missed, Fit::Recognized), 10);
        ousted.shorten(params.relocation.reinstated.way);
        contest.ousted = Some(ousted);
        let (contest, first) = contest.decided(first, &params);
        assert!(x(&first) == 0.0 && first.outlook == Outlook::Map && !contest.is_open());
    }
}
