use nalgebra::{Matrix3, Vector3, linalg::Cholesky};
use wayfix_estimation_traits::{Manifold, Pose2};

use crate::{Cloud, Params, ScanMatchError, misfit::Misfit};

/// Lays one scan on another.
#[derive(Clone, Copy, Debug)]
pub struct Matcher {
    params: Params,
}

/// Where a scan was taken, seen from another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alignment {
    /// The pose that fits guess and points best: `guess` ⊞ `correction`.
    pub pose: Pose2<f64>,
    /// What that changes of the guess, in its frame: m, m, rad.
    pub correction: Vector3<f64>,
    /// What the points alone know of the correction, $`Λ`$: the inverse of a covariance, singular where they leave a direction open.
    pub information: Matrix3<f64>,
    /// $`Λ z`$ with $`z`$ the correction that the points alone ask for.
    pub information_vector: Vector3<f64>,
    /// By how much the covariance of the guess had to be enlarged, because the scans say that it is off by more: below 1 where it is better than it says.
    pub guess_scale: f64,
    /// Share of the points that lie on a surface of the other scan.
    pub overlap: f64,
}

/// A match needs so many points in either scan.
const FEWEST_POINTS: usize = 10;
/// Degrees of freedom of the guess, $`ν`$.
const TAIL: f64 = 4.0;
/// The kernel narrows by this factor a step.
const NARROWING: f64 = 0.7;
/// A step this short ends the search, m and rad: far below what any laser tells.
const SHORT: f64 = 1e-5;
/// More starts than a full turn of doubt needs with the default spacing.
const MOST_STARTS: usize = 16;

impl Matcher {
    /// A matcher.
    ///
    /// # Errors
    /// When a parameter is out of range.
    pub fn new(params: Params) -> Result<Self, ScanMatchError> {
        params.check()?;
        Ok(Self { params })
    }

    /// Where `cloud` was taken in the frame of `reference`, from a guess and its covariance in the guess's own frame.
    ///
    /// Maximizes the posterior, the guess times a robust likelihood of the distances of points from the lines through their neighbours, by
    /// iteratively reweighted least squares with a kernel that narrows. The guess has the tails of a Student-t distribution, for wheels slip.
    /// Where its heading is in doubt, the search starts from several and the best posterior counts. [Censi 2008; Chen & Medioni 1992]
    ///
    /// # Errors
    /// When either scan has fewer than ten points, or the guess is not a finite pose with a positive definite covariance.
    pub fn align(
        &self,
        reference: &Cloud,
        cloud: &Cloud,
        guess: &Pose2<f64>,
        covariance: &Matrix3<f64>,
    ) -> Result<Alignment, ScanMatchError> {
        let got = reference.n_surfaces().min(cloud.points.len());
        if got < FEWEST_POINTS {
            return Err(ScanMatchError::TooFewPoints { got, needed: FEWEST_POINTS });
        }
        let prior = Cholesky::new(*covariance).map(|factor| factor.inverse());
        let prior = prior.filter(|prior| guess.is_finite() && prior.iter().all(|entry| entry.is_finite()));
        let prior = prior.ok_or(ScanMatchError::Guess)?;
        let searched = self.starts(covariance[(2, 2)].sqrt()).filter_map(|heading| {
            let start = Vector3::new(0.0, 0.0, heading);
            self.search(reference, cloud, guess, &prior, start)
        });
        let best = searched.min_by(|a, b| a.cost.total_cmp(&b.cost)).ok_or(ScanMatchError::Guess)?;
        let Found { correction, misfit, .. } = best;
        let guess_scale = guess_scale(&prior, &correction);
        Ok(Alignment {
            pose: guess.retract(&correction),
            correction,
            information: misfit.information,
            information_vector: (misfit.information + prior / guess_scale) * correction,
            guess_scale,
            overlap: misfit.n_on_surface as f64 / cloud.points.len() as f64,
        })
    }

    /// Headings to start from: the guess, and more to either side as far as three deviations reach.
    fn starts(&self, sigma: f64) -> impl Iterator<Item = f64> {
        let spacing = self.params.start_spacing_rad;
        let n = ((3.0 * sigma / spacing).round() as usize).min(MOST_STARTS) as i32;
        (-n..=n).map(move |i| f64::from(i) * spacing)
    }

    /// Goes downhill from one start; `None` when the numbers give out.
    fn search(
        &self,
        reference: &Cloud,
        cloud: &Cloud,
        guess: &Pose2<f64>,
        prior: &Matrix3<f64>,
        start: Vector3<f64>,
    ) -> Option<Found> {
        let Params { kernel_m, first_kernel_m, max_steps, .. } = self.params;
        let mut correction = start;
        let mut kernel = first_kernel_m.max(kernel_m);
        for _ in 0..max_steps {
            let misfit = Misfit::of(reference, cloud, guess, &correction, kernel, &self.params);
            let prior = prior / guess_scale(prior, &correction);
            let gradient = misfit.gradient + prior * correction;
            let step = Cholesky::new(misfit.information + prior)?.solve(&-gradient);
            correction += step;
            if kernel == kernel_m && step.amax() < SHORT {
                break;
            }
            kernel = (kernel * NARROWING).max(kernel_m);
        }
        let misfit = Misfit::of(reference, cloud, guess, &correction, kernel_m, &self.params);
        let nis = correction.dot(&(prior * correction));
        let cost = misfit.cost + (TAIL + 3.0) / 2.0 * (nis / TAIL).ln_1p();
        cost.is_finite().then_some(Found { correction, misfit, cost })
    }
}

/// $`(ν + δ^T P^{-1} δ) / (ν + 3)`$: what a Student-t distribution makes of the covariance at a distance.
fn guess_scale(prior: &Matrix3<f64>, correction: &Vector3<f64>) -> f64 {
    (TAIL + correction.dot(&(prior * correction))) / (TAIL + 3.0)
}

/// The end of one search.
struct Found {
    correction: Vector3<f64>,
    misfit: Misfit,
    /// Minus the logarithm of the posterior, nats.
    cost: f64,
}
