use std::f64::consts::TAU;

use rand::Rng;

use crate::random::deviate::{uniform, unit};

/// A smooth random path within [−1, 1] that does not repeat: a sum of sines with incommensurable periods.
#[derive(Clone, Copy, Debug)]
pub(super) struct SineSum {
    /// Size, radians a second, and where it begins.
    terms: [(f64, f64, f64); 3],
}

impl SineSum {
    /// The slowest of its swings takes about `period_s` seconds.
    pub(super) fn new<R: Rng + ?Sized>(period_s: f64, rng: &mut R) -> Self {
        let mut term = |size: f64, faster: f64| {
            (size, TAU * faster * uniform(0.85, 1.15, rng) / period_s, TAU * unit(rng))
        };
        Self { terms: [term(0.60, 1.0), term(0.28, 1.73), term(0.12, 2.91)] }
    }

    pub(super) fn at(&self, seconds: f64) -> f64 {
        self.terms.iter().map(|(size, rate, phase)| size * libm::sin(rate * seconds + phase)).sum()
    }

    /// Between two numbers instead of −1 and 1.
    pub(super) fn between(&self, low: f64, high: f64, seconds: f64) -> f64 {
        low + (high - low) * 0.5 * (1.0 + self.at(seconds))
    }
}
