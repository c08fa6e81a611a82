use wayfix_estimation_traits::Pose2;

use super::belief::{Belief, Outlook};
use super::breaks::Break;
use super::doubt::Doubt;
use super::fit::Fit;
use super::rival::{Rival, Round};
use super::running_share::RunningShare;
use super::{AppearanceLocalizer, LocalizerParams, Proof, RelocationParams};
use crate::{Descriptor, OdometryNoise, ReferenceSearch, separation_squared};

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

/// Who explores more than this may not have been carried: there is nothing to recognize there, so that any aisle that looks alike would win.
const MOST_EXPLORING: f64 = 0.9;

/// Way after a break within which whoever was put where something is known has recognized it, m: a few views.
const AT_ONCE_M: f64 = 1.0;

impl Contest {
    /// After the robot has moved. A belief beside the first that has become singular is dropped: it must not keep the robot from driving on.
    pub(super) fn moved(&self, increment: &Pose2<f64>, noise: &OdometryNoise) -> Self {
        let moved =
            |rival: &Rival| rival.belief.moved(increment, noise).map(|belief| rival.with(belief)).ok();
        let (rival, ousted) = (self.rival.as_ref().and_then(moved), self.ousted.as_ref().and_then(moved));
        Self { rival, ousted, ..*self }
    }

    /// Whether the rival recognizes more than the first does, or another goes along that was ousted: until that is decided nothing should be learned.
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

    /// The belief that is believed from now on: the rival's, or that of the one that was ousted, when it has won. One that has won where the first is ousts
    /// nobody.
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
        let Some(rival) = self.rival.as_ref().filter(proven) else { return (self, first) };
        let belief = rival.belief.clone();
        // One that was ousted before has been believed for longer.
        let left = self.ousted.map_or_else(|| Rival::ousted(&first), Rival::against_another);
        let ousted = Some(left).filter(|left| !is_same_place(&left.belief, &belief, params.fusion.gate));
        (Self { ousted, ..Self::default() }, belief)
    }
}

impl<D: Descriptor + Clone, S: ReferenceSearch<D>> AppearanceLocalizer<D, S> {
    /// The contest after a view; `first` is what the view makes of the first belief.
    pub(super) fn contested(&self, view: &D, first: &Belief) -> Contest {
        let params = &self.params.relocation;
        if params.doubt >= 1.0 || first.state.is_none() {
            return Contest::default();
        }
        let fit = self.fit(view, &self.belief);
        let exploring = self.contest.exploring.after(fit == Fit::Unknown, params.views);
        let is_break = self.is_break(view);
        let doubt = if is_break { Doubt::great(params) } else { self.contest.doubt.after(fit, params) };
        let way = self.motion.increment.translation.norm();
        let ousted = self.ousted_after(view, first, way, fit);
        if !doubt.is_great() {
            return Contest { doubt, exploring, broke: is_break, ousted, ..Contest::default() };
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
        // What has become singular begins again.
        let seen = self.seen(&before.belief, Some(view), &[]);
        let belief = seen.map_or_else(|_| nowhere.belief.clone(), |(belief, _)| belief);
        let goes_on = is_same_place(&before.belief, &belief, self.params.fusion.gate);
        let round = Round { way, first: fit, rival: self.fit(view, &before.belief) };
        let mut rival = before.with(belief);
        if goes_on {
            rival.goes_on(round);
        } else {
            rival.is_elsewhere();
        }
        rival.shorten(contest.proof(rival.way, params).way);
        Contest { rival: Some(rival), ..contest }
    }

    /// The one that was ousted after the view; `None` when it has gone along for long enough, has become singular, or is where the first is again.
    fn ousted_after(&self, view: &D, first: &Belief, way: f64, fit: Fit) -> Option<Rival> {
        let params = &self.params.relocation;
        let before = self.contest.ousted.as_ref().filter(|ousted| ousted.way < params.ousted_way)?;
        let (belief, _) = self.seen(&before.belief, Some(view), &[]).ok()?;
        let mut ousted = before.with(belief);
        ousted.goes_on(Round { way, first: fit, rival: self.fit(view, &before.belief) });
        ousted.shorten(params.reinstated.way);
        Some(ousted).filter(|ousted| !is_same_place(&ousted.belief, first, self.params.fusion.gate))
    }
}

/// Whether two beliefs put the robot at one place, by their heaviest hypotheses; not when one of them is singular.
fn is_same_place(one: &Belief, other: &Belief, gate: f64) -> bool {
    let separation = one.heaviest().zip(other.heaviest()).map(|(one, other)| separation_squared(one, other));
    matches!(separation, Some(Ok(squared)) if squared <= gate)
}

#[cfg(test)]
mod tests {
    use wayfix_gaussian_core::{Gaussian, GaussianMixture};

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

    fn at(x: f64) -> Belief {
        let pose = Pose2::new(x, 0.0, 0.0);
        let known = Gaussian::from_sigmas(pose, &nalgebra::Vector3::new(0.1, 0.1, 0.02));
        Belief::of_start(Start::Known(known.expect("sigmas are positive"))).expect("a finite start")
    }

    fn x(belief: &Belief) -> f64 {
        belief.heaviest().map_or(f64::NAN, |pose| pose.mean().x())
    }

    fn seen(rival: &mut Rival, fits: (Fit, Fit), n: usize) {
        (0..n).for_each(|_| rival.goes_on(Round { way: 0.5, first: fits.0, rival: fits.1 }));
    }

    /// One that has shown all that can be asked.
    fn proven(x: f64) -> Rival {
        let mut rival = Rival::nowhere(Outlook::Map).with(at(x));
        seen(&mut rival, (Fit::Missed, Fit::Recognized), 50);
        rival
    }

    #[test]
    fn who_was_ousted_goes_along_and_is_believed_again_when_it_alone_recognizes() {
        let params = LocalizerParams::default();
        let contest = Contest { rival: Some(proven(40.0)), ..Contest::default() };
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

    #[test]
    fn a_rival_that_is_where_the_first_is_ousts_nobody() {
        let contest = Contest { rival: Some(proven(0.1)), ..Contest::default() };
        let (contest, first) = contest.decided(at(0.0), &LocalizerParams::default());
        assert!(x(&first) == 0.1 && !contest.is_open());
    }

    #[test]
    fn a_rival_that_is_back_where_the_ousted_one_is_settles_it() {
        let ousted = Some(Rival::ousted(&at(0.0)));
        let contest = Contest { rival: Some(proven(0.1)), ousted, ..Contest::default() };
        let (contest, first) = contest.decided(at(40.0), &LocalizerParams::default());
        assert!(x(&first) == 0.1 && !contest.is_open());
    }

    #[test]
    fn what_was_shown_against_one_belief_counts_nothing_against_the_next() {
        let params = LocalizerParams::default();
        let mut ousted = Rival::ousted(&at(0.0));
        // Half a metre short of what has to be shown.
        seen(&mut ousted, (Fit::Missed, Fit::Recognized), 9);
        let contest = Contest { rival: Some(proven(80.0)), ousted: Some(ousted), ..Contest::default() };
        let (mut contest, first) = contest.decided(at(40.0), &params);
        assert_eq!(x(&first), 80.0);
        let mut ousted = contest.ousted.clone().expect("the first of all goes on along");
        assert_eq!(ousted.way, 4.5);
        seen(&mut ousted, (Fit::Missed, Fit::Recognized), 1);
        contest.ousted = Some(ousted);
        let (contest, first) = contest.decided(first, &params);
        assert!(x(&first) == 80.0 && contest.is_open());
    }

    #[test]
    fn a_belief_beside_the_first_that_breaks_is_dropped_and_the_robot_drives_on() {
        let broken = Gaussian::from_parts_unchecked(
            Pose2::new(0.0, 0.0, 0.0),
            nalgebra::Matrix3::from_element(f64::NAN),
        );
        let state = GaussianMixture::from_log_weights(vec![(0.0, broken)]).unwrap();
        let belief = Belief { state: Some(state), ..at(0.0) };
        let rival = Rival::nowhere(Outlook::Map).with(belief);
        let contest = Contest { rival: Some(rival.clone()), ousted: Some(rival), ..Contest::default() };
        let moved = contest.moved(&Pose2::new(0.25, 0.0, 0.0), &OdometryNoise::default());
        assert!(moved.rival.is_none() && moved.ousted.is_none());
    }
}
