use nalgebra::Matrix3;
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};
use wayfix_gaussian_core::{Gaussian, cholesky, symmetrize};

use crate::state::transition;
use crate::{AppearanceMapError, OdometryNoise};

/// Odometry between two views: the way, and the covariance of its error in the body frame at its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// From the pose of the one to the pose of the other, in the body frame of the first.
    pub increment: Pose2<f64>,
    /// Of the error, m² and rad².
    pub covariance: Matrix3<f64>,
}

impl Motion {
    /// No motion, and no doubt of it.
    pub fn none() -> Self {
        Self { increment: Pose2::identity(), covariance: Matrix3::zeros() }
    }

    /// This motion, and then another increment.
    ///
    /// # Errors
    /// When the increment, or where it leads, is not finite.
    pub fn then(&self, increment: &Pose2<f64>, noise: &OdometryNoise) -> Result<Self, AppearanceMapError> {
        let transition = transition(increment);
        let mut covariance =
            transition * self.covariance * transition.transpose() + noise.covariance(increment);
        symmetrize(&mut covariance);
        let motion = Self { increment: self.increment.compose(increment), covariance };
        let finite = motion.increment.is_finite() && covariance.iter().all(|entry| entry.is_finite());
        if finite { Ok(motion) } else { Err(AppearanceMapError::NotFinite { what: "odometry increment" }) }
    }

    /// A belief about the end of the motion taken back to its beginning.
    pub fn undone(&self, belief: &Gaussian<Pose2<f64>>) -> Gaussian<Pose2<f64>> {
        let back = self.increment.inverse();
        let transition = transition(&back);
        let mut covariance = transition * (belief.covariance() + self.covariance) * transition.transpose();
        symmetrize(&mut covariance);
        Gaussian::from_parts_unchecked(belief.mean().compose(&back), covariance)
    }

    /// A belief moved on. [Gross et al. 2005, Eq. 1]
    pub fn applied(&self, belief: &Gaussian<Pose2<f64>>) -> Gaussian<Pose2<f64>> {
        let transition = transition(&self.increment);
        let mut covariance = transition * belief.covariance() * transition.transpose() + self.covariance;
        symmetrize(&mut covariance);
        Gaussian::from_parts_unchecked(belief.mean().compose(&self.increment), covariance)
    }
}

/// Spreads what is known at the end of a way back over it: Rauch, Tung & Striebel's smoother on poses.
///
/// `filtered[k]` is what was believed at view $`k`$, `motions[k]` leads from there to view $`k+1`$. A correction at the end moves each earlier
/// pose by as much as the odometry up to it was in doubt: this is how states between two unimodal estimates are reconstructed.
/// [Porta & Kröse 2004 ask for the reconstruction; Rauch et al. 1965 for the form]
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_appearance_cml::{Motion, OdometryNoise, smooth};
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::Gaussian;
/// let sigmas = Vector3::new(1e-3, 1e-3, 1e-3);
/// let step = Motion::none().then(&Pose2::new(1.0, 0.0, 0.0), &OdometryNoise::default())?;
/// let start = Gaussian::from_sigmas(Pose2::new(0.0, 0.0, 0.0), &sigmas)?;
/// let half = step.applied(&start);
/// let seen = Gaussian::from_sigmas(Pose2::new(2.2, 0.0, 0.0), &sigmas)?; // odometry says 2.0
/// let smoothed = smooth(&[start, half, seen], &[step, step])?;
/// assert!((smoothed[1].mean().x() - 1.1).abs() < 1e-3); // half of the correction half way
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
///
/// # Errors
/// When a covariance is singular or there is not one motion between each two beliefs.
pub fn smooth(
    filtered: &[Gaussian<Pose2<f64>>],
    motions: &[Motion],
) -> Result<Vec<Gaussian<Pose2<f64>>>, AppearanceMapError> {
    let Some((last, earlier)) = filtered.split_last() else { return Ok(Vec::new()) };
    if motions.len() != earlier.len() {
        return Err(AppearanceMapError::Parameter {
            what: "number of motions",
            value: motions.len() as f64,
            range: "one less than of beliefs",
        });
    }
    let mut smoothed = vec![last.clone()];
    let mut next = last.clone();
    for (belief, motion) in earlier.iter().zip(motions).rev() {
        next = step_back(belief, motion, &next)?;
        smoothed.push(next.clone());
    }
    smoothed.reverse();
    Ok(smoothed)
}

/// $`G = C F^T P^{-1}`$, $`x^s = x ⊞ G (x'^s ⊟ x')`$, $`C^s = C + G (C'^s - P) G^T`$.
fn step_back(
    belief: &Gaussian<Pose2<f64>>,
    motion: &Motion,
    next: &Gaussian<Pose2<f64>>,
) -> Result<Gaussian<Pose2<f64>>, AppearanceMapError> {
    let predicted = motion.applied(belief);
    let forward = transition(&motion.increment) * belief.covariance();
    let gain = cholesky("predicted", predicted.covariance())?.solve(&forward).transpose();
    let carried = next.in_chart_at(predicted.mean())?;
    let mean = belief.mean().retract(&(gain * carried.mean()));
    let mut covariance =
        belief.covariance() + gain * (carried.covariance() - predicted.covariance()) * gain.transpose();
    let turn = belief.mean().chart_jacobian(&mean);
    covariance = turn * covariance * turn.transpose();
    symmetrize(&mut covariance);
    Ok(Gaussian::new(mean, covariance)?)
}
