use std::collections::VecDeque;

use wayfix_sensor_log::{Stamp, Velocity};
use wayfix_slam_ekf::VelocityControl;

use super::RobotTimingParams;

/// Velocity commands of the log, and the motion they make: later, and in shorter turns.
///
/// A command acts `command_delay` after its stamp. Around a change of commands the robot does, for `turn_command_time_loss`, whichever
/// turns less: a base that takes commands in its own rhythm loses a little of every turn. With both zero a command simply
/// holds until the next. No command holds longer than `velocity_timeout`; after that the motion is unknown.
#[derive(Clone, Debug)]
pub(super) struct Commands {
    delay: i128,
    time_loss: i128,
    hold: i128,
    rows: VecDeque<(i128, Velocity)>,
}

const STANDING: Velocity = Velocity { linear: 0.0, angular: 0.0 };

impl Commands {
    pub(super) fn new(robot: &RobotTimingParams) -> Self {
        Self {
            delay: nanoseconds(robot.command_delay),
            time_loss: nanoseconds(robot.turn_command_time_loss),
            hold: nanoseconds(robot.velocity_timeout),
            rows: VecDeque::new(),
        }
    }

    /// Takes the next row of the log.
    pub(super) fn push(&mut self, stamp: Stamp, velocity: Velocity) {
        self.rows.push_back((stamp.nanoseconds().into(), velocity));
    }

    /// Rows that may still act, oldest first.
    pub(super) fn rows(&self) -> impl Iterator<Item = (Stamp, Velocity)> {
        self.rows.iter().map(|(stamp, velocity)| (Stamp::from_nanoseconds(*stamp as u64), *velocity))
    }

    /// The motion between two times, cut where it changes.
    pub(super) fn between(&self, from: Stamp, to: Stamp) -> Vec<VelocityControl> {
        self.pieces(from, to).into_iter().map(|(_, control)| control).collect()
    }

    /// The same where a command holds.
    pub(super) fn known_between(&self, from: Stamp, to: Stamp) -> Vec<VelocityControl> {
        self.pieces(from, to).into_iter().filter(|(holds, _)| *holds).map(|(_, control)| control).collect()
    }

    /// Pieces of motion between two times, and whether a command holds in each.
    fn pieces(&self, from: Stamp, to: Stamp) -> Vec<(bool, VelocityControl)> {
        let (from, to) =
            (i128::from(from.nanoseconds()) - self.delay, i128::from(to.nanoseconds()) - self.delay);
        let changes =
            self.rows.iter().flat_map(|(stamp, _)| [*stamp, stamp + self.time_loss, stamp + self.hold]);
        let mut cuts: Vec<i128> = changes.filter(|cut| (from..to).contains(cut)).collect();
        cuts.extend([from, to]);
        cuts.sort_unstable();
        cuts.dedup();
        let piece = |pair: &[i128]| {
            let acting = self.acting_at(pair[0]);
            let Velocity { linear, angular } = acting.unwrap_or(STANDING);
            (
                acting.is_some(),
                VelocityControl { linear, angular, duration: (pair[1] - pair[0]) as f64 * 1e-9 },
            )
        };
        cuts.windows(2).map(piece).collect()
    }

    /// How much of the time between two times no command holds, s.
    pub(super) fn unknown_seconds(&self, from: Stamp, to: Stamp) -> f64 {
        let (from, to) =
            (i128::from(from.nanoseconds()) - self.delay, i128::from(to.nanoseconds()) - self.delay);
        let ends = self.rows.iter().skip(1).map(|(stamp, _)| *stamp).chain([i128::MAX]);
        let gaps = self.rows.iter().zip(ends).map(|((stamp, _), next)| (stamp + self.hold, next));
        let inside = gaps.map(|(begin, end)| (end.min(to) - begin.max(from)).max(0));
        inside.sum::<i128>() as f64 * 1e-9
    }

    /// Forgets what no longer acts at `time` or later.
    pub(super) fn forget_before(&mut self, time: Stamp) {
        let horizon = i128::from(time.nanoseconds()) - self.delay - self.time_loss;
        while self.rows.get(1).is_some_and(|(successor, _)| *successor <= horizon) {
            self.rows.pop_front();
        }
    }

    /// What the robot does at a time of the log: of the rows in force within the time loss before it, the one that turns least; `None` when
    /// no command holds.
    fn acting_at(&self, time: i128) -> Option<Velocity> {
        let until = self.rows.partition_point(|(stamp, _)| *stamp <= time);
        let (since, newest) = *self.rows.get(until.checked_sub(1)?)?;
        if time >= since + self.hold {
            return None;
        }
        let from = self.rows.partition_point(|(stamp, _)| *stamp <= time - self.time_loss).saturating_sub(1);
        let window = || self.rows.range(from..until).map(|(_, velocity)| *velocity);
        if window().any(|row| row.angular > 0.0) && window().any(|row| row.angular < 0.0) {
            return Some(Velocity { angular: 0.0, ..newest });
        }
        let least = |a: Velocity, b: Velocity| if b.angular.abs() < a.angular.abs() { b } else { a };
        Some(window().fold(newest, least))
    }
}

fn nanoseconds(seconds: f64) -> i128 {
    (seconds * 1e9).round() as i128
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    fn at(milliseconds: u64) -> Stamp {
        Stamp::from_nanoseconds(milliseconds * 1_000_000)
    }

    fn turn_of_100_ms(robot: RobotTimingParams) -> Vec<VelocityControl> {
        let mut commands = Commands::new(&robot);
        for (milliseconds, angular) in [(0, 0.0), (100, 0.5), (200, 0.0)] {
            commands.push(at(milliseconds), Velocity { linear: 0.1, angular });
        }
        commands.between(at(0), at(500))
    }

    fn turned(pieces: &[VelocityControl]) -> f64 {
        pieces.iter().map(|piece| piece.angular * piece.duration).sum()
    }

    #[test]
    fn a_command_holds_until_the_next() {
        let pieces = turn_of_100_ms(RobotTimingParams::default());
        assert_eq!(pieces.len(), 3);
        assert_abs_diff_eq!(turned(&pieces), 0.05, epsilon = 1e-12);
        assert_abs_diff_eq!(pieces.iter().map(|piece| piece.duration).sum::<f64>(), 0.5, epsilon = 1e-12);
    }

    #[test]
    fn a_delayed_command_acts_later_and_a_lossy_turn_is_shorter() {
        let robot = RobotTimingParams {
            command_delay: 0.15,
            turn_command_time_loss: 0.04,
            ..RobotTimingParams::default()
        };
        let pieces = turn_of_100_ms(robot);
        assert_abs_diff_eq!(turned(&pieces), 0.5 * 0.06, epsilon = 1e-12); // 40 ms of the 100 are lost
        let before: f64 =
            pieces.iter().take_while(|piece| piece.angular == 0.0).map(|piece| piece.duration).sum();
        assert_abs_diff_eq!(before, 0.29, epsilon = 1e-12); // 100 ms + delay + time loss
        assert_eq!(pieces[0].linear, 0.0); // stands until the first command acts
    }

    #[test]
    fn command_expires_and_the_motion_is_unknown() {
        let mut commands = Commands::new(&RobotTimingParams::default());
        commands.push(at(0), Velocity { linear: 1.0, angular: 0.0 });
        let driven = |pieces: &[VelocityControl]| pieces.iter().map(|p| p.linear * p.duration).sum::<f64>();
        assert_abs_diff_eq!(driven(&commands.between(at(0), at(5000))), 1.0, epsilon = 1e-12);
        assert_abs_diff_eq!(commands.unknown_seconds(at(0), at(5000)), 4.0, epsilon = 1e-12);
        commands.push(at(6000), Velocity { linear: 1.0, angular: 0.0 });
        assert_abs_diff_eq!(commands.unknown_seconds(at(5000), at(6500)), 1.0, epsilon = 1e-12);
        assert_eq!(commands.unknown_seconds(at(6000), at(7000)), 0.0);
    }

    #[test]
    fn forgets_only_what_no_longer_acts() {
        let robot = RobotTimingParams {
            command_delay: 0.15,
            turn_command_time_loss: 0.04,
            ..RobotTimingParams::default()
        };
        let mut commands = Commands::new(&robot);
        for step in 0..100 {
            commands.push(at(10 * step), Velocity { linear: 0.1, angular: step as f64 });
        }
        let expected = commands.between(at(900), at(990));
        commands.forget_before(at(900));
        assert!(commands.rows.len() < 40);
        assert_eq!(commands.between(at(900), at(990)), expected);
    }
}
