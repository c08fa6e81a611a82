use std::f64::consts::{PI, TAU};

use nalgebra::Vector2;
use rand::Rng;
use wayfix_estimation_traits::Pose2;

use super::FieldWalkParams;
use crate::league::field::spot;
use crate::plane;
use crate::random::deviate::{chance, uniform};

/// Path of the robot.
#[derive(Clone, Debug)]
pub(super) struct Walker {
    params: FieldWalkParams,
    pub(super) pose: Pose2<f64>,
    /// Forwards and to the left, m/s.
    velocity: Vector2<f64>,
    /// rad/s.
    turning: f64,
    task: Task,
}

#[derive(Clone, Copy, Debug)]
enum Task {
    Rest { left_s: f64 },
    Turn { to: Vector2<f64> },
    Walk { to: Vector2<f64>, sideways: bool },
}

/// Distance from the goal at which it has arrived, m.
const ARRIVED_M: f64 = 0.05;
/// Minimum distance of a new goal, m.
const WORTH_M: f64 = 1.2;
/// Remaining angle at which a turn is complete, rad.
const TURNED_RAD: f64 = 0.1;

impl Walker {
    pub(super) fn new(params: FieldWalkParams, start: Pose2<f64>) -> Self {
        Self {
            params,
            pose: start,
            velocity: Vector2::zeros(),
            turning: 0.0,
            task: Task::Rest { left_s: 0.5 },
        }
    }

    /// Somewhere on the field, any heading.
    pub(super) fn anywhere<R: Rng + ?Sized>(params: &FieldWalkParams, rng: &mut R) -> Pose2<f64> {
        let at = spot(params.min_board_distance_m, rng);
        Pose2::new(at.x, at.y, uniform(-PI, PI, rng))
    }

    /// Moves it to another pose, where it rests for a moment.
    pub(super) fn put(&mut self, pose: Pose2<f64>) {
        *self = Self::new(self.params, pose);
    }

    /// Speed as a share of its maximum speeds; may exceed 1 if it walks and turns at once.
    pub(super) fn activity(&self) -> f64 {
        let share = |now: f64, top: f64| if top > 0.0 { now / top } else { 0.0 };
        share(self.velocity.norm(), self.params.speed_mps) + share(self.turning.abs(), self.params.turn_radps)
    }

    /// Advances the time; returns the motion in its frame before.
    pub(super) fn step<R: Rng + ?Sized>(&mut self, step_s: f64, rng: &mut R) -> Pose2<f64> {
        let (velocity, turning) = self.command(step_s, rng);
        let reached = step_s / (self.params.speed_time_constant_s + step_s);
        self.velocity += (velocity - self.velocity) * reached;
        self.turning += (turning - self.turning) * reached;
        let moved = self.velocity * step_s;
        let ahead = plane::direction(self.pose.heading());
        let at = self.pose.translation + ahead * moved.x + Vector2::new(-ahead.y, ahead.x) * moved.y;
        let turned = self.turning * step_s;
        self.pose = Pose2::new(at.x, at.y, self.pose.heading() + turned);
        Pose2::new(moved.x, moved.y, turned)
    }

    fn command<R: Rng + ?Sized>(&mut self, step_s: f64, rng: &mut R) -> (Vector2<f64>, f64) {
        let still = (Vector2::zeros(), 0.0);
        match self.task {
            Task::Rest { left_s } if left_s > 0.0 => {
                self.task = Task::Rest { left_s: left_s - step_s };
                still
            }
            Task::Rest { .. } => {
                let (to, sideways) = (self.elsewhere(rng), chance(self.params.sideways_share, rng));
                self.task = if sideways { Task::Walk { to, sideways } } else { Task::Turn { to } };
                still
            }
            Task::Turn { to } => {
                let (_, bearing) = plane::range_and_bearing(&self.pose, &to);
                if bearing.abs() < TURNED_RAD {
                    self.task = Task::Walk { to, sideways: false };
                }
                (Vector2::zeros(), self.params.turn_radps.copysign(bearing))
            }
            Task::Walk { to, sideways } => self.walk(to, sideways, rng),
        }
    }

    /// A random goal that is usually far enough.
    fn elsewhere<R: Rng + ?Sized>(&self, rng: &mut R) -> Vector2<f64> {
        let mut to = spot(self.params.min_board_distance_m, rng);
        for _ in 0..10 {
            if (to - self.pose.translation).norm() > WORTH_M {
                break;
            }
            to = spot(self.params.min_board_distance_m, rng);
        }
        to
    }

    fn walk<R: Rng + ?Sized>(
        &mut self,
        to: Vector2<f64>,
        sideways: bool,
        rng: &mut R,
    ) -> (Vector2<f64>, f64) {
        let there = plane::to_body(&self.pose, &to);
        let distance = there.norm();
        if distance < ARRIVED_M {
            self.task = Task::Rest { left_s: 2.0 * self.params.mean_rest_s * uniform(0.0, 1.0, rng) };
            return (Vector2::zeros(), 0.0);
        }
        let velocity = there * (self.params.speed_mps / distance);
        let bearing = libm::atan2(there.y, there.x);
        let turning = if sideways { 0.0 } else { (2.0 * bearing).clamp(-0.5, 0.5) * self.params.turn_radps };
        (velocity, turning)
    }
}

/// The phase of a periodic motion after one more step.
pub(super) fn advance_phase(phase: f64, step: f64) -> f64 {
    (phase + step) % TAU
}
