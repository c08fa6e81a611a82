use wayfix_estimation_traits::Pose2;

use super::{CameraParams, ExposureMode, LampSetting, LeggedRobotParams};
use crate::{SimulationError, check};

/// One drive over the field with the camera running.
#[derive(Clone, Debug, PartialEq)]
pub struct LeagueParams {
    /// Number of frames, at most 100 000. Default 280.
    pub n_frames: usize,
    /// Time from one to the next, milliseconds; longer than the exposure. Default 100.
    pub period_ms: u32,
    /// Seed of the venue; with `None` the venue belongs to the seed of the drive. Default `None`.
    pub venue_seed: Option<u64>,
    /// The light from the frame on, in the order of the frames. Default bright from frame 0 on; so it is before the first. If frame 0
    /// is sunny, the camera's gain is set for the sun.
    pub lamp_settings: Vec<(usize, LampSetting)>,
    /// Start pose; `None` for a random one on the field. Default `None`.
    pub start: Option<Pose2<f64>>,
    /// Frames before which the robot is kidnapped, by at least 1 m. Default none.
    pub kidnap_frames: Vec<usize>,
    /// The robot.
    pub robot: LeggedRobotParams,
    /// Whether there are robots, a ball and a referee that no map lists. Default true.
    pub with_unmapped_objects: bool,
    /// Of the venue's camera. Default [`ExposureMode::Manual`].
    pub exposure_mode: ExposureMode,
    /// Chroma of the venue's paints as a share of what is usual, up to 1; at 0 all paints are grey. Default 1.
    pub paint_chroma: f64,
    /// Number of labelled frames in the log. Default 12.
    pub n_labelled_frames: usize,
}

impl Default for LeagueParams {
    fn default() -> Self {
        Self {
            n_frames: 280,
            period_ms: 100,
            venue_seed: None,
            lamp_settings: vec![(0, LampSetting::Bright)],
            start: None,
            kidnap_frames: Vec::new(),
            robot: LeggedRobotParams::default(),
            with_unmapped_objects: true,
            exposure_mode: ExposureMode::default(),
            paint_chroma: 1.0,
            n_labelled_frames: 12,
        }
    }
}

impl LeagueParams {
    /// Validates the parameters for this camera; those of the robot are validated when it is created.
    pub(super) fn validate(&self, camera: &CameraParams) -> Result<(), SimulationError> {
        check::count("frames", self.n_frames, 100_000)?;
        check::share("chroma of the paints", self.paint_chroma)?;
        let (exposure, period) = (f64::from(camera.exposure_ms), f64::from(self.period_ms));
        check::above("period of the frames (ms)", period, exposure + 2.0, "2 ms longer than the exposure")?;
        check::at_most("period of the frames (ms)", period, 60_000.0, "at most 60 000")?;
        let Some(start) = self.start else { return Ok(()) };
        check::finite("start (m)", start.x())?;
        check::finite("start (m)", start.y())?;
        check::finite("start (rad)", start.heading())
    }
}
