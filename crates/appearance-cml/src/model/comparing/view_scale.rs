use std::collections::VecDeque;

use crate::AppearanceMapError;

/// The difference of two views, and the distance between them along the path.
///
/// ```
/// use wayfix_appearance_cml::{ViewDifferenceModel, ViewDifferenceSample};
/// let mut scale = ViewDifferenceModel::default();
/// for distance in [0.3, 9.0, 0.3] {
///     scale.add_near(ViewDifferenceSample { lag: 0.25, distance }); // a person occludes the second view
/// }
/// // While far places are unknown, the sill is twice the median difference.
/// assert!((scale.match_limit(1.0) - 0.6).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewDifferenceSample {
    /// Distance along the path, m.
    pub lag: f64,
    /// Distance of the views.
    pub distance: f64,
}

/// How views change with distance: the scale of all differences between views, estimated from the data.
///
/// A variogram, as in geostatistics: $`E^2(d) ≈ n + s\,d`$ nearby, with the nugget $`n`$ of noise and the slope $`s`$, and a sill far away.
/// Its samples are views one step and a few steps apart along the path, and comparisons with references of far places. It takes medians,
/// so people in single views do not change it.
///
/// ```
/// use wayfix_appearance_cml::{ViewDifferenceSample, ViewDifferenceModel};
/// let mut scale = ViewDifferenceModel::default();
/// for _ in 0..20 {
///     scale.add_near(ViewDifferenceSample { lag: 0.1, distance: 1.0 });
///     scale.add_ahead(ViewDifferenceSample { lag: 0.5, distance: 1.5 });
///     scale.add_far(3.0);
/// }
/// assert!((scale.step() - 0.1).abs() < 1e-12);
/// // 1.5² - 1² per 0.4 m: a view that differs by 1.5 is 0.4 m further than one that differs by 1.
/// assert!((scale.to_meters(1.5) - scale.to_meters(1.0) - 0.4).abs() < 1e-9);
/// assert!(scale.match_limit(0.8) > 1.5 && scale.match_limit(0.8) < 3.0);
/// ```
#[derive(Clone, Debug, PartialEq, Default)]
pub struct ViewDifferenceModel {
    near: VecDeque<ViewDifferenceSample>,
    ahead: VecDeque<ViewDifferenceSample>,
    far: VecDeque<f64>,
    fitted: Fitted,
}

/// The fit to the samples.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
struct Fitted {
    step: f64,
    near: f64,
    nugget: f64,
    slope: f64,
    sill: f64,
}

/// Number of samples kept of each kind. The standard error of a median of 255 is 8 % of σ.
const KEPT: usize = 255;
/// Share of the views of far places below the sill: similar by chance. The sill needs at least one such sample.
const SILL_QUANTILE: f64 = 0.1;
/// Number of steps from which on a place is far, and the limit of [`ViewDifferenceModel::to_meters`]: 5 m, another aisle, at four
/// views per meter.
const FAR_STEPS: f64 = 20.0;

impl ViewDifferenceModel {
    /// A scale from its samples, as [`near`](Self::near), [`ahead`](Self::ahead) and [`far`](Self::far) give them.
    ///
    /// # Errors
    /// Returns an error if a number is negative or not finite.
    pub fn from_parts(
        near: &[ViewDifferenceSample],
        ahead: &[ViewDifferenceSample],
        far: &[f64],
    ) -> Result<Self, AppearanceMapError> {
        let mut scale = Self::default();
        for (samples, kept) in [(near, &mut scale.near), (ahead, &mut scale.ahead)] {
            for sample in samples {
                crate::check::not_negative("distance between views (m)", sample.lag)?;
                crate::check::not_negative("distance of views", sample.distance)?;
                keep(kept, *sample);
            }
        }
        for distance in far {
            crate::check::not_negative("distance of far views", *distance)?;
            keep(&mut scale.far, *distance);
        }
        scale.fit();
        Ok(scale)
    }

    /// Adds two views one step apart; ignores a sample that is not finite.
    pub fn add_near(&mut self, sample: ViewDifferenceSample) {
        if sample.lag.is_finite() && sample.distance.is_finite() {
            keep(&mut self.near, sample);
            self.fit();
        }
    }

    /// Adds two views a few steps apart; ignores a sample that is not finite.
    pub fn add_ahead(&mut self, sample: ViewDifferenceSample) {
        if sample.lag.is_finite() && sample.distance.is_finite() {
            keep(&mut self.ahead, sample);
            self.fit();
        }
    }

    /// Adds the distance to a reference of a far place; ignores a distance that is not finite.
    pub fn add_far(&mut self, distance: f64) {
        if distance.is_finite() {
            keep(&mut self.far, distance);
            self.fit();
        }
    }

    /// Samples one step apart, the oldest first.
    pub fn near(&self) -> impl Iterator<Item = ViewDifferenceSample> {
        self.near.iter().copied()
    }
    /// Samples a few steps apart, the oldest first.
    pub fn ahead(&self) -> impl Iterator<Item = ViewDifferenceSample> {
        self.ahead.iter().copied()
    }
    /// Distances to references of far places, the oldest first.
    pub fn far(&self) -> impl Iterator<Item = f64> {
        self.far.iter().copied()
    }

    /// Median distance between successive views along the path, m; 0 before the first two.
    pub fn step(&self) -> f64 {
        self.fitted.step
    }

    /// Median difference of successive views; 0 before the first two.
    pub(crate) fn step_distance(&self) -> f64 {
        self.fitted.near
    }

    /// $`E^{max}`$: the distance that lies `share` of the way (in squares) up from the nugget to the sill.
    ///
    /// Before far places are known the sill is twice the difference of successive views; before two views nothing matches.
    pub fn match_limit(&self, share: f64) -> f64 {
        let nugget = self.fitted.nugget;
        (nugget + share * (self.fitted.sill - nugget)).max(0.0).sqrt().max(self.fitted.near)
    }

    /// Distance from which on two places are far from one another, m: their views have nothing in common.
    pub fn far_distance(&self) -> f64 {
        FAR_STEPS * self.fitted.step
    }

    /// Distance between the places of two views with this difference, m: $`(E^2 - n)/s`$, between half a step and [`far_distance`](Self::far_distance).
    pub fn to_meters(&self, distance: f64) -> f64 {
        let Fitted { step, nugget, slope, .. } = self.fitted;
        let metres = (distance * distance - nugget) / slope;
        if metres.is_nan() { step } else { metres.clamp(step / 2.0, self.far_distance()) }
    }

    /// The square of a difference relative to the sill, $`E^2 / \text{sill}`$, at most 1.
    pub(crate) fn share_of_sill(&self, distance: f64) -> f64 {
        let share = distance * distance / self.fitted.sill;
        if share.is_nan() { 1.0 } else { share.min(1.0) }
    }

    fn is_sill_known(&self) -> bool {
        self.far.len() as f64 * SILL_QUANTILE >= 1.0
    }

    fn fit(&mut self) {
        let step = median(self.near.iter().map(|s| s.lag));
        let near = median(self.near.iter().map(|s| s.distance));
        let (ahead_lag, ahead) =
            (median(self.ahead.iter().map(|s| s.lag)), median(self.ahead.iter().map(|s| s.distance)));
        let rise = (ahead * ahead - near * near) / (ahead_lag - step);
        // Without different lags, all of the descriptor distance of successive views comes from the motion.
        let slope = if rise.is_finite() && rise > 0.0 { rise } else { near * near / step };
        let nugget = (near * near - slope * step).max(0.0);
        let sill = if self.is_sill_known() {
            quantile(self.far.iter().copied(), SILL_QUANTILE).powi(2)
        } else {
            (2.0 * near).powi(2)
        };
        self.fitted =
            Fitted { step, near, nugget: if nugget.is_finite() { nugget } else { 0.0 }, slope, sill };
    }
}

fn keep<T>(samples: &mut VecDeque<T>, sample: T) {
    if samples.len() == KEPT {
        samples.pop_front();
    }
    samples.push_back(sample);
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    quantile(values, 1.0 / 2.0)
}

/// The value that `share` of all lie under; 0 for none.
fn quantile(values: impl Iterator<Item = f64>, share: f64) -> f64 {
    let mut values: Vec<f64> = values.collect();
    let Some(last) = values.len().checked_sub(1) else { return 0.0 };
    let index = (last as f64 * share).round() as usize;
    *values.select_nth_unstable_by(index.min(last), f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_matches_before_two_views_are_known() {
        let scale = ViewDifferenceModel::default();
        assert_eq!((scale.match_limit(0.5), scale.step(), scale.to_meters(1.0)), (0.0, 0.0, 0.0));
    }

    #[test]
    fn occlusions_and_bad_numbers_do_not_change_the_scale() {
        let mut scale = ViewDifferenceModel::default();
        for k in 0..100 {
            // A person occludes every fourth view.
            scale.add_near(ViewDifferenceSample { lag: 0.1, distance: if k % 4 == 0 { 9.0 } else { 0.3 } });
            scale.add_near(ViewDifferenceSample { lag: f64::NAN, distance: 0.3 });
            scale.add_far(f64::INFINITY);
        }
        assert_eq!((scale.step(), scale.step_distance()), (0.1, 0.3));
        assert_eq!((scale.near().count(), scale.far().count()), (100, 0));
    }

    #[test]
    fn a_scale_is_its_samples() {
        let mut scale = ViewDifferenceModel::default();
        for k in 0..300 {
            let x = f64::from(k % 7);
            scale.add_near(ViewDifferenceSample { lag: 0.1, distance: 0.3 + 0.01 * x });
            scale.add_ahead(ViewDifferenceSample { lag: 0.4, distance: 0.6 + 0.01 * x });
            scale.add_far(1.0 + 0.01 * x);
        }
        let (near, ahead, far): (Vec<_>, Vec<_>, Vec<_>) =
            (scale.near().collect(), scale.ahead().collect(), scale.far().collect());
        assert_eq!(near.len(), KEPT, "the oldest make room");
        assert_eq!(ViewDifferenceModel::from_parts(&near, &ahead, &far), Ok(scale.clone()));
        assert!(ViewDifferenceModel::from_parts(&near, &ahead, &[f64::NAN]).is_err());
    }
}
