use nalgebra::Vector2;

/// Name, points and tolerance.
pub(crate) struct Case {
    pub(crate) name: String,
    pub(crate) points: Vec<Vector2<f64>>,
    pub(crate) epsilon: f64,
}

impl Case {
    /// The chain that every program is friendly with: a random walk of normal steps.
    pub(crate) fn walk(n: u32) -> Self {
        let mut uniform = xorshift();
        let mut at = Vector2::zeros();
        let step = |_| {
            let radius = (-2.0 * uniform().max(1e-300).ln()).sqrt();
            let (sin, cos) = (std::f64::consts::TAU * uniform()).sin_cos();
            at += Vector2::new(cos, sin) * radius;
            at
        };
        Self { name: format!("simplify walk {n}"), points: (0..n).map(step).collect(), epsilon: 5.0 }
    }

    /// Spikes that become smaller, so that every split takes one point off.
    pub(crate) fn zigzag(n: u32) -> Self {
        let height =
            |k: u32| if k.is_multiple_of(2) { 0.0 } else { 1e3 * (1.0 - f64::from(k) / f64::from(n)) };
        let points = (0..n).map(|k| Vector2::new(f64::from(k), height(k))).collect();
        Self { name: format!("simplify zigzag {n}"), points, epsilon: 1e-6 }
    }

    /// Teeth of one height: half the points are equally far from every line between teeth, and what decides is exact arithmetic.
    pub(crate) fn comb(n: u32) -> Self {
        let height = |k: u32| if k.is_multiple_of(2) { 0.0 } else { 0.7 };
        let points = (0..n).map(|k| Vector2::new(0.1 * f64::from(k), height(k))).collect();
        Self { name: format!("simplify comb {n}"), points, epsilon: 1e-6 }
    }

    /// A straight line but for the rounding of its coordinates, every bit of which is asked for.
    pub(crate) fn straight(n: u32) -> Self {
        let points = (0..n).map(|k| Vector2::new(0.1 * f64::from(k), 0.3 * f64::from(k))).collect();
        Self { name: format!("simplify straight {n}"), points, epsilon: 0.0 }
    }

    /// An open circle, where every point is on the hull.
    pub(crate) fn circle(n: u32) -> Self {
        let angle = |k: u32| std::f64::consts::TAU * 0.999 * f64::from(k) / f64::from(n - 1);
        let points = (0..n).map(|k| Vector2::new(angle(k).cos(), angle(k).sin()) * 1e3).collect();
        Self { name: format!("simplify circle {n}"), points, epsilon: 1e-3 }
    }
}

/// Uniform numbers in [0, 1), the same for every program [Marsaglia 2003].
pub(crate) fn xorshift() -> impl FnMut() -> f64 {
    let mut state = 88_172_645_463_325_252_u64;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}
