use super::params::Method;
use crate::{SmootherError, graph::structure::Structure};

/// First damping after a rejected Gauss–Newton step, relative to the diagonal, as in GTSAM.
const FIRST_DAMPING: f64 = 1e-5;
/// What a rejection multiplies the damping by, and an accepted step divides it by. [Marquardt 1963]
const FACTOR: f64 = 10.0;
/// Beyond it steps are shorter than the rounding of the variables.
const LARGEST_DAMPING: f64 = 1e16;

/// How far to trust the linearization.
pub(super) struct Damping {
    method: Method,
    /// λ of Levenberg–Marquardt.
    lambda: f64,
    /// Radius of the trust region, in units of the diagonal.
    radius: f64,
    dogleg: Option<Dogleg>,
}

/// A step to try.
pub(super) struct Step {
    pub(super) delta: Vec<f64>,
    /// Decrease of the cost if the residuals were linear.
    pub(super) predicted: f64,
    /// Whether it is a whole Gauss–Newton step, or all but one.
    pub(super) is_full: bool,
}

/// The two ends of the dogleg.
struct Dogleg {
    cauchy: Vec<f64>,
    newton: Vec<f64>,
}

impl Damping {
    pub(super) fn new(method: Method) -> Self {
        Self { method, lambda: 0.0, radius: f64::INFINITY, dogleg: None }
    }

    /// The normal equations are those of another point.
    pub(super) fn relinearized(&mut self) {
        self.dogleg = None;
    }

    /// The next step to try; `None` when steps have become too short to change anything.
    pub(super) fn step(&mut self, structure: &mut Structure) -> Result<Option<Step>, SmootherError> {
        match self.method {
            Method::GaussNewton => newton(structure).map(Some),
            Method::LevenbergMarquardt => self.levenberg_marquardt(structure),
            Method::Dogleg => self.dogleg(structure),
        }
    }

    /// Whether to accept a step, by the gain ratio of its decrease to the predicted one.
    pub(super) fn judge(&mut self, cost: f64, new_cost: f64, step: &Step, structure: &Structure) -> bool {
        let gain = (cost - new_cost) / step.predicted;
        let accepted = new_cost < cost;
        match self.method {
            Method::GaussNewton => return true,
            Method::LevenbergMarquardt if accepted => self.decrease(),
            Method::LevenbergMarquardt => self.increase(),
            Method::Dogleg => {
                let length = scaled_norm(&step.delta, &structure.scale());
                // [Nocedal & Wright 2006, Algorithm 4.1]
                if gain > 0.75 {
                    self.radius = self.radius.max(2.0 * length);
                } else if gain < 0.25 || gain.is_nan() {
                    self.radius = 0.25 * length;
                }
            }
        }
        accepted
    }

    fn increase(&mut self) {
        self.lambda = if self.lambda == 0.0 { FIRST_DAMPING } else { self.lambda * FACTOR };
    }

    fn decrease(&mut self) {
        self.lambda = if self.lambda <= FIRST_DAMPING { 0.0 } else { self.lambda / FACTOR };
    }

    /// $`(H + λ D) δ = -g`$
    fn levenberg_marquardt(&mut self, structure: &mut Structure) -> Result<Option<Step>, SmootherError> {
        while self.lambda <= LARGEST_DAMPING {
            if structure.factorize(self.lambda).is_err() {
                self.increase();
                continue;
            }
            let delta = structure.solve()?;
            let damped = scaled_norm(&delta, &structure.scale()).powi(2) * self.lambda;
            let predicted = damped - dot(&delta, structure.equations.gradient());
            return Ok(Some(Step { delta, predicted, is_full: self.lambda <= FIRST_DAMPING }));
        }
        Ok(None)
    }

    fn dogleg(&mut self, structure: &mut Structure) -> Result<Option<Step>, SmootherError> {
        let scale = structure.scale();
        let ends = match self.dogleg.take() {
            Some(ends) => ends,
            None => Dogleg { cauchy: cauchy(structure, &scale), newton: newton(structure)?.delta },
        };
        let (to_newton, to_cauchy) = (scaled_norm(&ends.newton, &scale), scaled_norm(&ends.cauchy, &scale));
        let is_full = to_newton <= self.radius;
        let delta = if is_full {
            ends.newton.clone()
        } else if to_cauchy >= self.radius {
            ends.cauchy.iter().map(|entry| entry * self.radius / to_cauchy).collect()
        } else {
            on_the_second_leg(&ends, &scale, self.radius)
        };
        self.dogleg = Some(ends);
        let curved = dot(&delta, &structure.equations.multiply(&delta));
        let predicted = -2.0 * dot(&delta, structure.equations.gradient()) - curved;
        Ok((predicted > 0.0 || is_full).then_some(Step { delta, predicted, is_full }))
    }
}

fn newton(structure: &mut Structure) -> Result<Step, SmootherError> {
    if structure.factorize(0.0).is_err() {
        return Err(structure.ill_conditioned());
    }
    let delta = structure.solve()?;
    let predicted = -dot(&delta, structure.equations.gradient());
    Ok(Step { delta, predicted, is_full: true })
}

/// The minimum along the scaled gradient.
fn cauchy(structure: &Structure, scale: &[f64]) -> Vec<f64> {
    let gradient = structure.equations.gradient();
    let direction: Vec<f64> = gradient.iter().zip(scale).map(|(g, d)| -g / d).collect();
    let slope = -dot(&direction, gradient);
    let curvature = dot(&direction, &structure.equations.multiply(&direction));
    let length = if curvature > 0.0 { slope / curvature } else { 0.0 };
    direction.iter().map(|entry| entry * length).collect()
}

/// Where the way from the Cauchy point to the Newton point leaves the trust region.
fn on_the_second_leg(ends: &Dogleg, scale: &[f64], radius: f64) -> Vec<f64> {
    let leg: Vec<f64> = ends.newton.iter().zip(&ends.cauchy).map(|(n, c)| n - c).collect();
    let (mut a, mut b, mut c) = (0.0, 0.0, -radius * radius);
    for ((leg, start), scale) in leg.iter().zip(&ends.cauchy).zip(scale) {
        a += scale * leg * leg;
        b += scale * leg * start;
        c += scale * start * start;
    }
    let share = (-b + (b * b - a * c).max(0.0).sqrt()) / a;
    ends.cauchy.iter().zip(&leg).map(|(start, leg)| start + share * leg).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn scaled_norm(v: &[f64], scale: &[f64]) -> f64 {
    v.iter().zip(scale).map(|(v, d)| d * v * v).sum::<f64>().sqrt()
}
