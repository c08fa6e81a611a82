/// $`S(y_t, y_i)`$: 1 for the same view, falling smoothly to 0 at the limit $`E^{max}`$ and beyond.
///
/// $`S = (1 - (E / E^{max})^2)^2`$: flat at both ends, so that neither noise nor the limit makes it jump. The paper asks for 1 and 0 at the ends and
/// leaves the form open. [Gross et al. 2005, Sec. 2.2]
///
/// ```
/// use wayfix_appearance_cml::similarity;
/// assert_eq!((similarity(0.0, 2.0), similarity(2.0, 2.0), similarity(3.0, 2.0)), (1.0, 0.0, 0.0));
/// assert!(similarity(0.9, 2.0) > similarity(1.0, 2.0));
/// ```
pub fn similarity(distance: f64, limit: f64) -> f64 {
    // NaN is not similar.
    if distance < limit { (1.0 - (distance / limit).powi(2)).powi(2) } else { 0.0 }
}
