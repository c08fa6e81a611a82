use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, MotionModel, Pose2, SensorModel, UpdateAlloc};
use wayfix_gaussian_core::{ChiSquaredGate, GaussianMixture};
use wayfix_kalman::{ExtendedKalmanAlgorithm, KalmanAlgorithm};

use super::{AppearanceLocalizer, LocalizerEvent, belief::Belief, measured_poses::MeasuredPoses};
use crate::{AppearanceMapError, GaussianFusionRule, ReferenceSearch, ViewDescriptor};

impl<D: ViewDescriptor + Clone, S: ReferenceSearch<D>, M> AppearanceLocalizer<D, S, M>
where
    M: MotionModel<State = Pose2<f64>, Control = Pose2<f64>>,
{
    /// Corrects the belief by another estimator of the pose, or of a part of it, whose errors are independent of odometry and views. [Gross et al. 2005, Fig. 2]
    ///
    /// Each component $`i`$ is fused with the measurement by split covariance intersection, which for an independent measurement is the Kalman update
    /// [Julier & Uhlmann 2001]. Its weight is multiplied by its evidence $`N(z ⊟ h(μ_i); 0, S_i)`$. The uniform component has the evidence $`1/V`$, with the
    /// extent $`V`$ of what is measured (`volume`): m² of the map for positions, $`2π`$ for headings.
    ///
    /// With [`GaussianFusionRule::WeightedIntersection`], as published, the measurement is a mixture that [`fuse`](crate::fuse) takes as it takes a view: one
    /// hypothesis for each component, which has what is not measured from that component.
    ///
    /// ```
    /// use nalgebra::{Matrix2, Vector2, Vector3};
    /// use wayfix_appearance_cml::{AppearanceLocalizer, LinearSearch, LocalizerParams, PanoramaDescriptor, StartPosePrior};
    /// use wayfix_estimation_traits::{Pose2, SensorModel};
    /// use wayfix_gaussian_core::{ChiSquaredGate, Gaussian};
    /// struct Receiver;
    /// impl SensorModel for Receiver {
    ///     type State = Pose2<f64>;
    ///     type Measurement = Vector2<f64>;
    ///     fn expected(&self, pose: &Pose2<f64>) -> Vector2<f64> { pose.translation }
    ///     fn noise(&self, _: &Pose2<f64>) -> Matrix2<f64> { Matrix2::identity() }
    /// }
    /// let start = StartPosePrior::Known(Gaussian::from_sigmas(Pose2::new(0.0, 0.0, 0.0), &Vector3::new(1.0, 1.0, 0.1))?);
    /// let mut robot = AppearanceLocalizer::<PanoramaDescriptor, LinearSearch<_>>::new(LocalizerParams::default(), start)?;
    /// let gate = ChiSquaredGate::from_probability(2, 0.9999)?;
    /// robot.correct(&Receiver, &Vector2::new(1.0, 0.0), &gate, 100.0)?;
    /// assert!((robot.estimate().expect("a pose").mean().x() - 0.5).abs() < 1e-9); // half way between two of equal variance
    /// assert!(robot.correct(&Receiver, &Vector2::new(100.0, 0.0), &gate, 100.0).is_err());
    /// assert!((robot.estimate().expect("a pose").mean().x() - 0.5).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Returns [`AppearanceMapError::UnknownPose`] if there is no component to correct, [`AppearanceMapError::Outlier`] if `gate` accepts the innovation of none, or an error
    /// of the measurement; the belief is then unchanged.
    pub fn correct<H>(
        &mut self,
        sensor: &H,
        measurement: &H::Measurement,
        gate: &ChiSquaredGate,
        volume: f64,
    ) -> Result<Vec<LocalizerEvent>, AppearanceMapError>
    where
        H: SensorModel<State = Pose2<f64>, Measurement: Manifold<Scalar = f64>>,
        DefaultAllocator: UpdateAlloc<<Pose2<f64> as Manifold>::Dim, <H::Measurement as Manifold>::Dim>,
    {
        crate::check::positive("extent of what is measured", volume)?;
        let Some(state) = &self.belief.state else { return Err(AppearanceMapError::UnknownPose) };
        let (mut corrected, mut least_nis) = (Vec::new(), f64::INFINITY);
        for (log_weight, component) in state.log_weights().iter().zip(state.components()) {
            let (innovation, posterior) =
                ExtendedKalmanAlgorithm.update(component, sensor, measurement, |_| true)?;
            least_nis = least_nis.min(innovation.nis());
            let posterior = posterior.unwrap_or_else(|| component.clone());
            corrected.push((log_weight + innovation.log_likelihood(), posterior));
        }
        if !gate.accepts(least_nis) {
            return Err(AppearanceMapError::Outlier { nis: least_nis, threshold: gate.threshold() });
        }
        if self.params.fusion.fusion_rule == GaussianFusionRule::WeightedIntersection {
            let posteriors = corrected.iter().map(|(_, posterior)| posterior);
            let measured = MeasuredPoses::new(state, posteriors)?;
            let belief = self.belief.fused(None, &[&measured], self.map.area(), &self.params)?;
            return self.replace_belief(belief, self.kidnap.clone(), false);
        }
        corrected.sort_by(|a, b| b.0.total_cmp(&a.0)); // the heaviest first
        let largest = corrected.first().map_or(0.0, |(log_weight, _)| *log_weight);
        let sum: f64 = corrected.iter().map(|(log_weight, _)| (log_weight - largest).exp()).sum();
        let evidence = (1.0 - self.belief.uniform) * sum * largest.exp();
        let anywhere = self.belief.uniform / volume;
        let uniform = if evidence + anywhere > 0.0 { anywhere / (evidence + anywhere) } else { 0.0 };
        let belief = Belief { state: Some(GaussianMixture::from_log_weights(corrected)?), uniform };
        self.replace_belief(belief, self.kidnap.clone(), false)
    }
}
