use nalgebra::{Matrix3, Vector3, linalg::Cholesky};
use wayfix_estimation_traits::{Manifold, Pose2};

use crate::{Cloud, Params, ScanMatchError, misfit::Misfit};

/// Lays one scan on another.
#[derive(Clone, Copy, Debug)]
pub struct Matcher {
    params: Params,
}

/// The prior of the pose of the second scan.
#[derive(Clone, Copy, Debug)]
pub struct Guess<'a> {
    /// The most likely pose in the frame of the first scan.
    pub pose: Pose2<f64>,
    /// Its covariance in its own frame: m and rad.
    pub covariance: Matrix3<f64>,
    /// Poses to start from where the scans hardly fit near the guess: for wheels that slip, where the robot was, or where it would be if it had gone on
    /// as before.
    pub alternative_poses: &'a [Pose2<f64>],
}

/// The pose of a scan in the frame of another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alignment {
    /// The pose that fits guess and points best: `guess` ⊞ `correction`.
    pub pose: Pose2<f64>,
    /// The correction of the guess, in its frame: m, m, rad.
    pub correction: Vector3<f64>,
    /// The information of the points alone about the correction, $`Λ`$: the inverse of a covariance, singular if a direction is undetermined.
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
/// Scans that have this share of points in common fit; below it, a search from elsewhere may find better.
const GOOD_OVERLAP: f64 = 0.8;
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
    /// Returns [`ScanMatchError::Value`] if a parameter is out of range.
    pub fn new(params: Params) -> Result<Self, ScanMatchError> {
        params.check()?;
        Ok(Self { params })
    }

    /// The pose of `cloud` in the frame of `reference`.
    ///
    /// Maximizes the posterior, the guess times a robust likelihood of the distances of points from the lines through their neighbours, by
    /// iteratively reweighted least squares with a kernel that narrows. The guess has the tails of a Student-t distribution, for wheels slip.
    /// Where its heading is in doubt, the search starts from several and the best posterior counts. [Censi 2008; Chen & Medioni 1992]
    ///
    /// # Errors
    /// Returns an error if either scan has fewer than ten points, or the guess is not a finite pose with a positive definite covariance.
    pub fn align(
        &self,
        reference: &Cloud,
        cloud: &Cloud,
        guess: &Guess,
    ) -> Result<Alignment, ScanMatchError> {
        let got = reference.n_surface_points().min(cloud.points.len());
        if got < FEWEST_POINTS {
            return Err(ScanMatchError::TooFewPoints { got, needed: FEWEST_POINTS });
        }
        let prior = Cholesky::new(guess.covariance).map(|factor| factor.inverse());
        let prior =
            prior.filter(|prior| guess.pose.is_finite() && prior.iter().all(|entry| entry.is_finite()));
        let prior = prior.ok_or(ScanMatchError::Guess)?;
        let search =
            |start| self.search(reference, cloud, &guess.pose, &prior, start, self.params.initial_kernel_m);
        let mut found: Vec<Found> = self.starts(guess.covariance[(2, 2)].sqrt()).filter_map(search).collect();
        let fits = |found: &Found| found.misfit.n_inliers as f64 >= GOOD_OVERLAP * cloud.points.len() as f64;
        if !found.iter().any(fits) {
            let others = guess.alternative_poses.iter().filter(|other| other.is_finite());
            found.extend(others.filter_map(|other| {
                let start = guess.pose.local(other);
                self.search(reference, cloud, &guess.pose, &prior, start, self.params.kernel_m) // near already
            }));
        }
        let best = found.into_iter().min_by(|a, b| a.cost.total_cmp(&b.cost)).ok_or(ScanMatchError::Guess)?;
        let Found { correction, misfit, .. } = best;
        let guess_scale = guess_scale(&prior, &correction);
        Ok(Alignment {
            pose: guess.pose.retract(&correction),
            correction,
            information: misfit.information,
            information_vector: (misfit.information + prior / guess_scale) * correction,
            guess_scale,
            overlap: misfit.n_inliers as f64 / cloud.points.len() as f64,
        })
    }

    /// Headings to start from: the guess, and more to either side as far as three deviations reach.
    fn starts(&self, sigma: f64) -> impl Iterator<Item = Vector3<f64>> {
        let spacing = self.params.start_spacing_rad;
        let n = ((3.0 * sigma / spacing).round() as usize).min(MOST_STARTS) as i32;
        (-n..=n).map(move |i| Vector3::new(0.0, 0.0, f64::from(i) * spacing))
    }

    /// Goes downhill from one start; `None` when the numbers give out.
    fn search(
        &self,
        reference: &Cloud,
        cloud: &Cloud,
        guess: &Pose2<f64>,
        prior: &Matrix3<f64>,
        start: Vector3<f64>,
        first_kernel: f64,
    ) -> Option<Found> {
        let Params { kernel_m, max_steps, .. } = self.params;
        let mut correction = start;
        let mut kernel = first_kernel.max(kernel_m);
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
