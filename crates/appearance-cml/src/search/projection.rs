/// How many numbers are left of the invariants.
pub(super) const N_DIMS: usize = 16;

/// What is left of a view's invariants. Distances never grow.
pub(super) type Sketch = [f32; N_DIMS];

/// The orthonormal directions in which the invariants of some views spread most.
///
/// Distances of projections never exceed those of what is projected, whatever the directions are: learned ones only make more of them large.
#[derive(Clone, Debug)]
pub(super) struct Projection {
    directions: Vec<Vec<f64>>,
}

/// Rounds of orthogonal iteration: directions need not be accurate to be useful.
const N_ROUNDS: usize = 6;

impl Projection {
    /// From the invariants of some views, all as long.
    pub(super) fn learn(samples: &[Vec<f64>]) -> Self {
        let n = samples.first().map_or(0, Vec::len);
        let mean: Vec<f64> = (0..n)
            .map(|i| samples.iter().map(|sample| sample[i]).sum::<f64>() / samples.len() as f64)
            .collect();
        let centred: Vec<Vec<f64>> = samples
            .iter()
            .map(|sample| sample.iter().zip(&mean).map(|(x, mean)| x - mean).collect())
            .collect();
        // Any start will do that is not orthogonal to all that matters.
        let mut directions: Vec<Vec<f64>> = (0..N_DIMS.min(n)).map(|k| unit(n, k)).collect();
        orthonormalize(&mut directions);
        for _ in 0..N_ROUNDS {
            directions = directions.iter().map(|direction| spread(&centred, direction)).collect();
            orthonormalize(&mut directions);
        }
        Self { directions }
    }

    pub(super) fn sketch(&self, invariants: &[f64]) -> Sketch {
        let mut sketch = Sketch::default();
        for (value, direction) in sketch.iter_mut().zip(&self.directions) {
            *value = dot(direction, invariants) as f32;
        }
        sketch
    }
}

/// Covariance times a direction, up to a factor.
fn spread(centred: &[Vec<f64>], direction: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; direction.len()];
    for sample in centred {
        let along = dot(sample, direction);
        sum.iter_mut().zip(sample).for_each(|(sum, x)| *sum += along * x);
    }
    sum
}

/// Gram-Schmidt, twice for orthogonality to the last digits; a direction that has nothing of its own becomes zero.
fn orthonormalize(directions: &mut [Vec<f64>]) {
    for index in 0..directions.len() {
        let (before, from) = directions.split_at_mut(index);
        let direction = &mut from[0];
        let length = dot(direction, direction).sqrt();
        for _ in 0..2 {
            for other in before.iter() {
                let along = dot(direction, other);
                direction.iter_mut().zip(other).for_each(|(x, other)| *x -= along * other);
            }
        }
        let own = dot(direction, direction).sqrt();
        let scale = if own > 1e-9 * length { own.recip() } else { 0.0 };
        direction.iter_mut().for_each(|x| *x *= scale);
    }
}

fn unit(n: usize, k: usize) -> Vec<f64> {
    (0..n).map(|i| f64::from(u8::from(i % N_DIMS == k))).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Spread 1 in direction 3, 0.1 in direction 20, nothing elsewhere.
    fn samples() -> Vec<Vec<f64>> {
        let value = |i: usize, step: f64| (i as f64 * step).fract() - 0.5;
        let sample = |i: usize| {
            let mut sample = vec![0.7; 40];
            sample[3] += value(i, 0.618_034);
            sample[20] += 0.1 * value(i, 0.414_214);
            sample
        };
        (0..100).map(sample).collect()
    }

    #[test]
    fn projection_never_increases_a_distance() {
        let samples = samples();
        let projection = Projection::learn(&samples);
        for (a, b) in samples.iter().zip(&samples[1..]) {
            let between =
                |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            let [p, q] = [a, b].map(|sample| projection.sketch(sample).map(f64::from).to_vec());
            let (whole, left) = (between(a, b), between(&p, &q));
            // 1e-6: sketches are single precision.
            assert!(left <= whole + 1e-6 && left > 0.999 * whole - 1e-6, "{left} of {whole}");
        }
    }

    #[test]
    fn projection_of_equal_or_few_samples_is_finite() {
        let same = Projection::learn(&vec![vec![0.3; 40]; 5]);
        assert_eq!(same.sketch(&[0.3; 40]), same.sketch(&[0.3; 40]));
        let short = Projection::learn(&[vec![1.0, 2.0], vec![2.0, 1.0]]);
        assert!(short.sketch(&[1.0, 2.0]).iter().all(|value| value.is_finite()));
        assert_eq!(Projection::learn(&[]).sketch(&[]), [0.0; N_DIMS]);
    }
}
