use wayfix_appearance_cml::{AzimuthDirection, PanoramaDescriptor, ViewDescriptor};
use wayfix_estimation_traits::wrap_angle;
use wayfix_system_core::{EventCounts, ODOMETRY_SCALE_TOLERANCE};

/// Turns between views of the same place: by the path, and as seen with descriptors of clockwise columns.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TurnEvidence {
    /// Mean disagreement, rad, if columns run clockwise.
    clockwise: f64,
    /// If columns run counterclockwise.
    counterclockwise: f64,
    /// If the camera does not turn.
    fixed: f64,
    /// Seen turn over that of the path, ascending.
    ratios: Vec<f64>,
}

/// How far views turn, as a multiple of the turns of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TurnScale {
    median: f64,
    /// Bounds of the median, with three standard deviations of the ranks.
    interval: [f64; 2],
}

impl TurnScale {
    /// Says when views contradict the path beyond its calibration.
    pub(super) fn warn(&self, events: &mut EventCounts) {
        let Self { median, interval: [low, high] } = self;
        if *high < 1.0 - ODOMETRY_SCALE_TOLERANCE || *low > 1.0 + ODOMETRY_SCALE_TOLERANCE {
            let text = format!(
                "views turn {median:.2} times as far as the robot does by odometry or the table of poses ({low:.2} to {high:.2}): check the unit, the scale and the sign of its turns, and the order of columns (`--column-order`)"
            );
            events.warn("views_contradict_odometry", text);
        }
    }
}

/// Frame distances of the compared pairs of views. Near views look alike, far views have turned.
const LAGS: [usize; 5] = [2, 4, 8, 16, 32];
/// Upper bound of a disagreement, rad; a larger one is a failed comparison.
const MOST: f64 = 0.5;
/// Smaller turns of the path may be noise and are skipped, rad.
const LEAST_TURN: f64 = 0.25;
/// Views whose distance exceeds this share of the typical distance show different places.
const ALIKE: f64 = 0.8;
/// Random turns disagree by 0.46 rad on average, with [`MOST`] as bound; those of a noisy path by half of that.
const UNRELATED: f64 = 0.35;
/// Fewer turns are not conclusive.
const ENOUGH: usize = 10;
/// Maximum number of comparisons per lag.
const N_COMPARED: usize = 400;
/// Larger turns of the path may be whole turns in the views, rad.
const MOST_TURN: f64 = 2.0;

impl TurnEvidence {
    /// Whether the camera clearly never turns.
    pub(super) fn is_fixed(&self) -> bool {
        self.fixed < 0.5 * self.clockwise.min(self.counterclockwise)
    }

    /// Whether the turns of the views are unrelated to the path.
    pub(super) fn is_unrelated(&self) -> bool {
        self.fixed.min(self.clockwise).min(self.counterclockwise) > UNRELATED
    }

    /// Whether columns run counterclockwise.
    pub(super) fn is_counterclockwise(&self) -> bool {
        self.counterclockwise < self.clockwise
    }

    /// How far views turn if columns run in this direction; `None` after too few turns. The bounds of a median are order statistics
    /// [David & Nagaraja 2003, 7.1]. Pairs of the five distances share their views: they count as one.
    pub(super) fn scale(&self, direction: AzimuthDirection) -> Option<TurnScale> {
        let n = self.ratios.len();
        let half_width = 1.5 * ((n * LAGS.len()) as f64).sqrt();
        let at = |rank: f64| (0.0..n as f64).contains(&rank).then(|| self.ratios[rank as usize]);
        let middle = n as f64 / 2.0;
        let [median, low, high] = [at(middle)?, at(middle - half_width)?, at(middle + half_width)?];
        Some(match direction {
            AzimuthDirection::Clockwise => TurnScale { median, interval: [low, high] },
            AzimuthDirection::Counterclockwise => TurnScale { median: -median, interval: [-high, -low] },
        })
    }
}

/// Compares the turns between successive views with the headings of a path; `None` if too few pairs of the same place turn.
pub(super) fn turn_evidence(views: &[PanoramaDescriptor], headings: &[f64]) -> Option<TurnEvidence> {
    let n = views.len().min(headings.len());
    let alike = ALIKE * typical_distance(&views[..n])?;
    let pairs = LAGS.iter().flat_map(|lag| {
        let every = (n.saturating_sub(*lag) / N_COMPARED).max(1);
        (0..n.saturating_sub(*lag)).step_by(every).map(move |from| (from, from + lag))
    });
    let mut sums = [0.0; 3];
    let mut n_turns = 0;
    let mut ratios = Vec::new();
    for (from, to) in pairs {
        let turned = wrap_angle(headings[to] - headings[from]);
        if turned.abs() < LEAST_TURN {
            continue;
        }
        let seen = views[to].compare(&views[from]);
        if seen.distance < alike {
            let errors = [seen.rotation - turned, seen.rotation + turned, seen.rotation];
            let terms = errors.map(|error| wrap_angle(error).abs().min(MOST));
            sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
            n_turns += 1;
            ratios.extend((turned.abs() < MOST_TURN).then_some(seen.rotation / turned));
        }
    }
    ratios.sort_by(f64::total_cmp);
    let [clockwise, counterclockwise, fixed] = sums.map(|sum| sum / n_turns.max(1) as f64);
    (n_turns >= ENOUGH).then_some(TurnEvidence { clockwise, counterclockwise, fixed, ratios })
}

/// The median distance of unrelated views.
fn typical_distance(views: &[PanoramaDescriptor]) -> Option<f64> {
    let half = views.len() / 2;
    let mut distances: Vec<f64> = (0..half)
        .step_by((half / 64).max(1))
        .map(|index| views[index].compare(&views[index + half]).distance)
        .collect();
    distances.sort_by(f64::total_cmp);
    distances.get(distances.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use approx::assert_abs_diff_eq;
    use rand::RngExt;
    use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
    use wayfix_appearance_cml::{Panorama, PanoramaDescriptorExtractor, PanoramaDescriptorParams};

    use super::*;

    const N_COLUMNS: usize = 120;
    const N_RINGS: usize = 8;
    /// Of the camera between two views, in columns: 0.105 rad.
    const TURN: usize = 2;

    /// Views of a camera that turns left on the spot, then at another place; columns clockwise.
    fn views(n: usize) -> Vec<PanoramaDescriptor> {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let mut scene = || (0..N_COLUMNS * N_RINGS).map(|_| rng.random()).collect::<Vec<u8>>();
        let scenes = [scene(), scene()];
        let params = PanoramaDescriptorParams {
            azimuth_direction: AzimuthDirection::Clockwise,
            ..PanoramaDescriptorParams::default()
        };
        let extractor = PanoramaDescriptorExtractor::new(params, N_COLUMNS, N_RINGS).unwrap();
        let view = |step: usize| {
            let shift = N_COLUMNS - TURN * step % N_COLUMNS;
            let scene = &scenes[usize::from(2 * step >= n)];
            let cell = |at: usize| scene[at / N_COLUMNS * N_COLUMNS + (at % N_COLUMNS + shift) % N_COLUMNS];
            let rgb = (0..scene.len()).flat_map(|at| [cell(at); 3]).collect();
            extractor.describe(&Panorama::from_rgb(N_COLUMNS, N_RINGS, rgb).unwrap()).unwrap()
        };
        (0..n).map(view).collect()
    }

    /// The scale if odometry turns so much as much as the camera.
    fn scale(odometry: f64, direction: AzimuthDirection) -> TurnScale {
        let views = views(60);
        let turn = odometry * TURN as f64 * TAU / N_COLUMNS as f64;
        let headings: Vec<f64> = (0..views.len()).map(|step| turn * step as f64).collect();
        turn_evidence(&views, &headings).unwrap().scale(direction).unwrap()
    }

    fn is_said(scale: &TurnScale) -> bool {
        let mut events = EventCounts::default();
        scale.warn(&mut events);
        events.get("views_contradict_odometry") == 1
    }

    #[test]
    fn scale_is_that_of_the_turns() {
        for (odometry, direction, expected) in [
            (1.0, AzimuthDirection::Clockwise, 1.0),
            (0.8, AzimuthDirection::Clockwise, 1.25),
            (-1.0, AzimuthDirection::Counterclockwise, 1.0),
            (-1.0, AzimuthDirection::Clockwise, -1.0),
        ] {
            let TurnScale { median, .. } = scale(odometry, direction);
            assert_abs_diff_eq!(median, expected, epsilon = 0.05);
        }
    }

    #[test]
    fn wrong_scales_and_signs_are_said_and_calibration_is_not() {
        assert!(!is_said(&scale(1.1, AzimuthDirection::Clockwise)));
        for wrong in [-1.0, 0.7, 1.5] {
            assert!(is_said(&scale(wrong, AzimuthDirection::Clockwise)), "{wrong}");
        }
    }

    #[test]
    fn few_turns_say_nothing() {
        let views = views(20);
        let headings: Vec<f64> = (0..views.len()).map(|step| 0.07 * step as f64).collect();
        let evidence = turn_evidence(&views, &headings).unwrap();
        assert_eq!(evidence.scale(AzimuthDirection::Clockwise), None);
    }
}
