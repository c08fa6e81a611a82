use std::f64::consts::TAU;

use crate::random::{RandomStreamPurpose, RandomStreams, deviate};
use crate::{SimulationError, check};

/// The drive and its noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MonobotParams {
    /// Number of steps, at most 1e6. Default 100 (the paper's).
    pub n_steps: usize,
    /// Number of landmarks, all at one place, at most 10 000. Default 1.
    pub n_landmarks: usize,
    /// Start and end position of the robot, m. Default −1 (the paper's).
    pub start_and_end_m: f64,
    /// Position of the landmarks, m. Default 1 (the paper's).
    pub landmark_position_m: f64,
    /// Amplitude of the robot's motion, m. Default 1 (the paper states none).
    pub motion_amplitude_m: f64,
    /// σ of a motion as a share of the commanded motion. Default 0.1 (the paper states none).
    pub motion_sigma_share: f64,
    /// σ of a range as a share of the distance. Default 0.05 (the paper states none).
    pub range_sigma_share: f64,
    /// σ of the external position sensor, m. Default 0.05 (the paper states none).
    pub external_position_sigma_m: f64,
}

impl Default for MonobotParams {
    fn default() -> Self {
        Self {
            n_steps: 100,
            n_landmarks: 1,
            start_and_end_m: -1.0,
            landmark_position_m: 1.0,
            motion_amplitude_m: 1.0,
            motion_sigma_share: 0.1,
            range_sigma_share: 0.05,
            external_position_sigma_m: 0.05,
        }
    }
}

/// One drive: plain samples. Index k of the measurements belongs to `positions[k]`.
#[derive(Clone, Debug, PartialEq)]
pub struct MonobotRun {
    /// Commanded motion $`u_k`$ from step k to k + 1, metres; `n_steps` of them.
    pub controls: Vec<f64>,
    /// True positions $`x_k`$, metres; `n_steps + 1`.
    pub positions: Vec<f64>,
    /// True positions of the landmarks, metres.
    pub landmarks: Vec<f64>,
    /// Signed distances $`z_k^{(i)} = x_f^{(i)} - x_k + w`$ to every landmark, metres: one row a position.
    pub ranges: Vec<Vec<f64>>,
    /// Signed distances $`-x_k + w`$ to a known reference at the origin, metres. [Andrade-Cetto 2005, Eq. 20]
    pub anchor_ranges: Vec<f64>,
    /// Positions $`x_k + w`$ by an external sensor, metres. [Sec. 2.2, "An external sensor"]
    pub external_positions: Vec<f64>,
}

impl MonobotParams {
    /// Simulates $`x_{k+1} = x_k + u_k + v_k`$ with $`v_k ∼ N(0, (α u_k)^2)`$, [Andrade-Cetto 2005, Eq. 19]; the commands are the increments of $`x_0 + A \sin(2πk/N)`$.
    /// ```
    /// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
    /// use wayfix_scene_sim::{monobot::MonobotParams, random::RandomStreams};
    /// let run = MonobotParams::default().simulate(&mut RandomStreams::new(ChaCha8Rng::seed_from_u64(1)))?;
    /// assert_eq!((run.controls.len(), run.positions.len(), run.positions[0]), (100, 101, -1.0));
    /// assert!(run.controls.iter().sum::<f64>().abs() < 1e-12); // commanded back to where it began
    /// # Ok::<(), wayfix_scene_sim::SimulationError>(())
    /// ```
    ///
    /// # Errors
    /// Returns [`SimulationError::Parameter`] or [`SimulationError::TooMany`] if a parameter is out of range.
    pub fn simulate(&self, streams: &mut RandomStreams) -> Result<MonobotRun, SimulationError> {
        self.validate()?;
        let controls: Vec<f64> = (0..self.n_steps).map(|k| self.planned(k + 1) - self.planned(k)).collect();
        let positions = self.positions(&controls, streams);
        let landmarks = vec![self.landmark_position_m; self.n_landmarks];
        let mut noise = |source, sigma: f64| sigma * deviate::normal(streams.of(source));
        let mut measured =
            |source, distance: f64| distance + noise(source, self.range_sigma_share * distance.abs());
        let ranges = positions
            .iter()
            .map(|x| {
                landmarks
                    .iter()
                    .map(|landmark| measured(RandomStreamPurpose::RangeNoise, landmark - x))
                    .collect()
            })
            .collect();
        let anchor_ranges = positions.iter().map(|x| measured(RandomStreamPurpose::Anchor, -x)).collect();
        let external_positions = positions
            .iter()
            .map(|x| x + noise(RandomStreamPurpose::ExternalPosition, self.external_position_sigma_m))
            .collect();
        Ok(MonobotRun { controls, positions, landmarks, ranges, anchor_ranges, external_positions })
    }

    fn validate(&self) -> Result<(), SimulationError> {
        check::count("steps", self.n_steps, 1_000_000)?;
        check::count("landmarks", self.n_landmarks, 10_000)?;
        check::count("ranges", self.n_steps.saturating_mul(self.n_landmarks), 100_000_000)?;
        check::finite("start (m)", self.start_and_end_m)?;
        check::finite("place of the landmarks (m)", self.landmark_position_m)?;
        check::finite("amplitude (m)", self.motion_amplitude_m)?;
        check::not_negative("σ of a motion", self.motion_sigma_share)?;
        check::not_negative("σ of a range", self.range_sigma_share)?;
        check::not_negative("σ of the external sensor (m)", self.external_position_sigma_m)
    }

    /// The noise-free position after `k` steps.
    fn planned(&self, k: usize) -> f64 {
        self.start_and_end_m + self.motion_amplitude_m * libm::sin(TAU * k as f64 / self.n_steps as f64)
    }

    fn positions(&self, controls: &[f64], streams: &mut RandomStreams) -> Vec<f64> {
        let mut x = self.start_and_end_m;
        let moved = controls.iter().map(|u| {
            x += u + self.motion_sigma_share
                * u.abs()
                * deviate::normal(streams.of(RandomStreamPurpose::OdometryNoise));
            x
        });
        std::iter::once(self.start_and_end_m).chain(moved).collect()
    }
}
