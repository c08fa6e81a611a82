use std::f64::consts::PI;

use wayfix_estimation_traits::LieGroup;

use super::{ODOMETRY_SCALE_TOLERANCE, TurnHistory};

/// Turns of odometry that count, rad: if it is calibrated, the sensor sees at most half a turn.
const MOST_TURN: f64 = PI / (1.0 + ODOMETRY_SCALE_TOLERANCE);

/// Fewer turns have no normal sum.
const ENOUGH: usize = 30;

/// Standard errors between a slope and its bound.
const N_SIGMAS: f64 = 3.0;

impl TurnHistory {
    /// Bounds of the ratio of the sensor's turns to those of odometry; `None` if the turns do not tell.
    ///
    /// Both have errors of unknown size. If these are independent of each other, the ratio lies between the two regressions of the one on the other [Frisch 1934],
    /// here with three standard errors each. It is negative if one of the signs is wrong.
    pub fn turn_scale(&self) -> Option<[f64; 2]> {
        let odometry = self.odometry.windows(2).map(|pair| pair[0].1.inverse().compose(&pair[1].1).heading());
        let turns = odometry.zip(self.seen.iter().skip(1)).filter_map(|(turn, seen)| Some((turn, (*seen)?)));
        let turns: Vec<(f64, f64)> = turns.filter(|(turn, _)| turn.abs() < MOST_TURN).collect();
        if turns.len() < ENOUGH {
            return None;
        }
        let [slope, sigma] = regression(turns.iter().copied());
        let [inverse, inverse_sigma] = regression(turns.iter().map(|(turn, seen)| (*seen, *turn)));
        let low = slope.abs() - N_SIGMAS * sigma;
        let inverse_low = (inverse.abs() - N_SIGMAS * inverse_sigma).max(0.0);
        // If a slope may be zero, or is not a number, the turns have nothing in common.
        (low > 0.0).then(|| {
            let high = inverse_low.recip();
            if slope > 0.0 { [low, high] } else { [-high, -low] }
        })
    }
}

/// The slope of the second of two numbers on the first, through the origin, and its standard error, whatever the error of each pair is.
/// [MacKinnon & White 1985, HC3]
fn regression(pairs: impl Iterator<Item = (f64, f64)> + Clone) -> [f64; 2] {
    let square: f64 = pairs.clone().map(|(x, _)| x * x).sum();
    let slope = pairs.clone().map(|(x, y)| x * y).sum::<f64>() / square;
    let term = |(x, y): (f64, f64)| x * (y - slope * x) / (1.0 - x * x / square);
    let sigma = pairs.map(|pair| term(pair).powi(2)).sum::<f64>().sqrt() / square;
    [slope, sigma]
}

#[cfg(test)]
mod tests {
    use rand::RngExt;
    use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
    use rand_distr::StandardNormal;
    use wayfix_estimation_traits::Pose2;
    use wayfix_sensor_log::Stamp;

    use super::*;

    /// Turns of a robot that turns by a normal angle of `turn_sigma`, rad, between two views; odometry and views err by these sigmas, and odometry is `scale` times
    /// the truth.
    fn bounds(scale: f64, turn_sigma: f64, [odometry, views]: [f64; 2], seed: u64) -> Option<[f64; 2]> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = |sigma: f64| sigma * rng.sample::<f64, _>(StandardNormal);
        let mut history = TurnHistory::default();
        let mut pose = Pose2::identity();
        for _ in 0..300 {
            let turn = normal(turn_sigma);
            pose = pose.compose(&Pose2::new(0.0, 0.0, scale * turn + normal(odometry)));
            history.push(Stamp::default(), pose, Some(turn + normal(views)));
        }
        history.turn_scale()
    }

    #[test]
    fn the_factor_lies_within_the_bounds() {
        for seed in 0..20 {
            for scale in [1.0, 0.7, 1.5, -1.0] {
                for errors in [[0.02, 0.1], [0.1, 0.02], [0.1, 0.1]] {
                    let [low, high] = bounds(scale, 0.3, errors, seed).expect("turns that tell");
                    let factor = 1.0 / scale;
                    assert!(low < factor && factor < high, "{seed}, {scale}, {errors:?}: {low} to {high}");
                }
            }
        }
    }

    #[test]
    fn small_errors_give_narrow_bounds_and_large_ones_wide_ones() {
        let [low, high] = bounds(1.0, 0.3, [0.01, 0.01], 1).expect("turns that tell");
        assert!(0.98 < low && high < 1.02, "{low} to {high}");
        // Straight on: all turns are errors.
        let [_, high] = bounds(1.0, 0.01, [0.1, 0.01], 1).unwrap_or([0.0, f64::INFINITY]);
        assert!(high > 1.0, "{high}");
    }

    #[test]
    fn few_turns_and_rest_do_not_tell() {
        assert_eq!(TurnHistory::default().turn_scale(), None);
        assert_eq!(bounds(1.0, 0.0, [0.0, 0.0], 1), None);
    }
}
