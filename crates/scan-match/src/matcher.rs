use nalgebra::{Matrix3, Vector3, linalg::Cholesky};
use wayfix_estimation_traits::{Manifold, Pose2};

use crate::{ScanMatchError, ScanMatchParams, ScanPointCloud, misfit::Misfit};

/// Matches one scan to another.
#[derive(Clone, Copy, Debug)]
pub struct ScanMatcher {
    params: ScanMatchParams,
}

/// The prior of the pose of the second scan.
#[derive(Clone, Copy, Debug)]
pub struct InitialGuess<'a> {
    /// The most likely pose in the frame of the first scan.
    pub pose: Pose2<f64>,
    /// Its covariance in its own frame: m and rad.
    pub covariance: Matrix3<f64>,
    /// Further start poses, used if the scans overlap little near the guess. After wheel slip, for example the pose before, or the one at constant
    /// velocity.
    pub alternative_poses: &'a [Pose2<f64>],
}

/// The pose of a scan in the frame of another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScanAlignment {
    /// The pose that fits guess and points best: `guess` ⊞ `correction`.
    pub pose: Pose2<f64>,
    /// The correction of the guess, in its frame: m, m, rad.
    pub correction: Vector3<f64>,
    /// The information of the points alone about the correction, $`Λ`$: the inverse of a covariance, singular if a direction is undetermined.
    pub information: Matrix3<f64>,
    /// $`Λ z`$ with $`z`$ the correction from the points alone.
    pub information_vector: Vector3<f64>,
    /// Factor on the covariance of the guess that explains its error according to the scans: below 1 if the guess is better than its covariance
    /// states.
    pub guess_scale: f64,
    /// Share of the points that lie on a surface of the other scan.
    pub overlap: f64,
}

/// Minimum number of points of each scan.
const FEWEST_POINTS: usize = 10;
/// Overlap above which a match is accepted without further starts.
const GOOD_OVERLAP: f64 = 0.8;
/// Degrees of freedom of the guess, $`ν`$.
const TAIL: f64 = 4.0;
/// The kernel narrows by this factor a step.
const NARROWING: f64 = 0.7;
/// A shorter step ends the search, m and rad; it is far below the accuracy of lasers.
const SHORT: f64 = 1e-5;
/// Maximum number of start headings on each side of the guess; half a turn at the default spacing needs fewer.
const MOST_STARTS: usize = 16;

impl ScanMatcher {
    /// A matcher.
    ///
    /// # Errors
    /// Returns [`ScanMatchError::Value`] if a parameter is out of range.
    pub fn new(params: ScanMatchParams) -> Result<Self, ScanMatchError> {
        params.check()?;
        Ok(Self { params })
    }

    /// The pose of `cloud` in the frame of `reference`.
    ///
    /// Maximizes the posterior: the prior of the guess times a robust likelihood of the point-to-line distances, by iteratively reweighted least
    /// squares with a kernel that narrows. The prior is a Student-t distribution, to tolerate wheel slip. If its heading is uncertain, the search
    /// has several starts and the best posterior counts. [Censi 2008; Chen & Medioni 1992]
    /// # Errors
    /// Returns an error if either scan has fewer than ten points, or the guess is not a finite pose with a positive definite covariance.
    pub fn align(
        &self,
        reference: &ScanPointCloud,
        cloud: &ScanPointCloud,
        guess: &InitialGuess,
    ) -> Result<ScanAlignment, ScanMatchError> {
        let got = reference.n_surface_points().min(cloud.points.len());
        if got < FEWEST_POINTS {
            return Err(ScanMatchError::TooFewPoints { got, needed: FEWEST_POINTS });
        }
        let prior = Cholesky::new(guess.covariance).map(|factor| factor.inverse());
        let prior =
            prior.filter(|prior| guess.pose.is_finite() && prior.iter().all(|entry| entry.is_finite()));
        let prior = prior.ok_or(ScanMatchError::Guess)?;
        let search = |start| {
            self.search(
                reference,
                cloud,
                &guess.pose,
                &prior,
                start,
                self.params.initial_robust_kernel_width_m,
            )
        };
        let mut found: Vec<Found> = self.starts(guess.covariance[(2, 2)].sqrt()).filter_map(search).collect();
        let fits = |found: &Found| found.misfit.n_inliers as f64 >= GOOD_OVERLAP * cloud.points.len() as f64;
        if !found.iter().any(fits) {
            let others = guess.alternative_poses.iter().filter(|other| other.is_finite());
            found.extend(others.filter_map(|other| {
                let start = guess.pose.local(other);
                self.search(reference, cloud, &guess.pose, &prior, start, self.params.robust_kernel_width_m) // near already
            }));
        }
        let best = found.into_iter().min_by(|a, b| a.cost.total_cmp(&b.cost)).ok_or(ScanMatchError::Guess)?;
        let Found { correction, misfit, .. } = best;
        let guess_scale = guess_scale(&prior, &correction);
        Ok(ScanAlignment {
            pose: guess.pose.retract(&correction),
            correction,
            information: misfit.information,
            information_vector: (misfit.information + prior / guess_scale) * correction,
            guess_scale,
            overlap: misfit.n_inliers as f64 / cloud.points.len() as f64,
        })
    }

    /// Start headings: the guess, and more on both sides up to three deviations.
    fn starts(&self, sigma: f64) -> impl Iterator<Item = Vector3<f64>> {
        let spacing = self.params.initial_heading_spacing_rad;
        let n = ((3.0 * sigma / spacing).round() as usize).min(MOST_STARTS) as i32;
        (-n..=n).map(move |i| Vector3::new(0.0, 0.0, f64::from(i) * spacing))
    }

    /// Descends from one start; `None` on numerical failure.
    fn search(
        &self,
        reference: &ScanPointCloud,
        cloud: &ScanPointCloud,
        guess: &Pose2<f64>,
        prior: &Matrix3<f64>,
        start: Vector3<f64>,
        first_kernel: f64,
    ) -> Option<Found> {
        let ScanMatchParams { robust_kernel_width_m, max_iterations: max_steps, .. } = self.params;
        let mut correction = start;
        let mut kernel = first_kernel.max(robust_kernel_width_m);
        for _ in 0..max_steps {
            let misfit = Misfit::of(reference, cloud, guess, &correction, kernel, &self.params);
            let prior = prior / guess_scale(prior, &correction);
            let gradient = misfit.gradient + prior * correction;
            let step = Cholesky::new(misfit.information + prior)?.solve(&-gradient);
            correction += step;
            if kernel == robust_kernel_width_m && step.amax() < SHORT {
                break;
            }
            kernel = (kernel * NARROWING).max(robust_kernel_width_m);
        }
        let misfit = Misfit::of(reference, cloud, guess, &correction, robust_kernel_width_m, &self.params);
        let nis = correction.dot(&(prior * correction));
        let cost = misfit.cost + (TAIL + 3.0) / 2.0 * (nis / TAIL).ln_1p();
        cost.is_finite().then_some(Found { correction, misfit, cost })
    }
}

/// $`(ν + δ^T P^{-1} δ) / (ν + 3)`$: covariance scale of a Student-t distribution at this distance.
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
