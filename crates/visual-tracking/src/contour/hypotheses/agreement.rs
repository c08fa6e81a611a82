use super::super::ColorContourTrackerParams;

/// Agreement of a segmentation with the known target, each part from 0 to 1.
/// [Andrade-Cetto 2005, Sec. 3.3, "Measure and weight"]
/// ```
/// use wayfix_visual_tracking::{ColorHypothesisAgreement, ColorContourTrackerParams};
/// let perfect = ColorHypothesisAgreement { affine: 1.0, area: ColorHypothesisAgreement::of_areas(400.0, 400.0), quality: ColorHypothesisAgreement::of_euler_number(1, 10.0) };
/// let params = ColorContourTrackerParams::default();
/// assert_eq!((perfect.mismatch(&params), perfect.log_weight(&params), perfect.score(&params)), (0.0, 0.0, 1.0));
/// assert_eq!(ColorHypothesisAgreement::of_areas(400.0, 300.0), 0.75);
/// assert_eq!(ColorHypothesisAgreement::of_euler_number(-1, 10.0), 0.8); // two holes
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorHypothesisAgreement {
    /// $`Φ_\text{affine}`$: the share of the fitted snake that lies on the segmented boundary.
    pub affine: f64,
    /// $`Φ_\text{area}`$, see [`of_areas`](Self::of_areas).
    pub area: f64,
    /// $`Φ_\text{quality}`$, see [`of_euler_number`](Self::of_euler_number).
    pub quality: f64,
}

impl ColorHypothesisAgreement {
    /// No agreement.
    pub(in crate::contour) const NONE: Self = Self { affine: 0.0, area: 0.0, quality: 0.0 };

    /// $`Φ_\text{area} = 1 - |\tilde A - A| / \max(\tilde A, A)`$. The paper prints only the fraction, which would reward a wrong area.
    pub fn of_areas(predicted: f64, area: f64) -> f64 {
        let larger = predicted.max(area);
        if larger > 0.0 { 1.0 - (predicted - area).abs() / larger } else { 0.0 }
    }

    /// $`Φ_\text{quality} = 1 - |1 - E| / r`$, not below 0: 1 for one part without a hole.
    pub fn of_euler_number(euler_number: i64, range: f64) -> f64 {
        (1.0 - (1 - euler_number).unsigned_abs() as f64 / range).max(0.0)
    }

    /// $`ρ = μ_1 (1 - Φ_\text{affine}) + μ_2 (1 - Φ_\text{area}) + μ_3 (1 - Φ_\text{quality})`$.
    pub fn mismatch(&self, params: &ColorContourTrackerParams) -> f64 {
        let [affine, area, quality] = params.agreement_weights;
        affine * (1.0 - self.affine) + area * (1.0 - self.area) + quality * (1.0 - self.quality)
    }

    /// $`\log π = -ρ^2 / 2σ^2`$ in nats.
    pub fn log_weight(&self, params: &ColorContourTrackerParams) -> f64 {
        -0.5 * (self.mismatch(params) / params.agreement_sigma).powi(2)
    }

    /// $`1 - ρ / (μ_1 + μ_2 + μ_3)`$, from 0 to 1.
    pub fn score(&self, params: &ColorContourTrackerParams) -> f64 {
        1.0 - self.mismatch(params) / params.agreement_weights.iter().sum::<f64>()
    }
}
