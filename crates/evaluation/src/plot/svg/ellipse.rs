/// Points on the ellipse of `sigmas` standard deviations, closed: $`μ + k L (\cos φ, \sin φ)`$ with the Cholesky factor $`L`$; `None` if
/// the covariance is not positive definite.
pub(in crate::plot) fn ellipse(
    center: (f64, f64),
    covariance: [[f64; 2]; 2],
    sigmas: f64,
) -> Vec<(f64, f64)> {
    const N_POINTS: u32 = 48;
    let [[xx, xy], [_, yy]] = covariance;
    let l_xx = xx.sqrt();
    let l_yx = xy / l_xx;
    let l_yy = (yy - l_yx * l_yx).sqrt();
    if !(l_xx > 0.0 && l_yy > 0.0 && l_yx.is_finite()) {
        return Vec::new();
    }
    let point = |k: u32| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k % N_POINTS) / f64::from(N_POINTS)).sin_cos();
        (center.0 + sigmas * l_xx * cos, center.1 + sigmas * (l_yx * cos + l_yy * sin))
    };
    (0..=N_POINTS).map(point).collect()
}
