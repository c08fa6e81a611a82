use super::{AcquisitionParams, CameraNoise, HiddenViews, OdometryNoise};
use crate::{ColorModelError, PixelLikelihoodParams};

/// What [`ColorLocalizer`](crate::ColorLocalizer) is tuned by.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct LocalizerParams {
    /// How pixels are weighed.
    pub pixels: PixelLikelihoodParams,
    /// How far odometry is from the truth.
    pub odometry: OdometryNoise,
    /// How far the camera is from where the joints say.
    pub camera: CameraNoise,
    /// How the robot is looked for at first.
    pub acquisition: AcquisitionParams,
    /// Fewest particles.
    pub min_particles: usize,
    /// Most particles while the robot knows where it is.
    pub max_particles: usize,
    /// Most particles while it does not: at a start anywhere, and after it was carried away.
    pub max_particles_lost: usize,
    /// Resample when the effective share of particles falls below this.
    pub resample_below: f64,
    /// Fewest pixels from which the mean of a colour is taken.
    pub min_pixels: u64,
    /// A colour whose means the lighting filter never learns from, by its place in the map: what the other colours tell of it is seen then.
    pub withheld: Option<usize>,
    /// Share of the effective particles that a frame has to leave: its likelihood is softened until it does.
    pub least_effective: f64,
    /// How often and for how long somebody stands in front of the camera.
    pub hidden_views: HiddenViews,
    /// How the long-term and the short-term average of the fit follow a frame's: rates of augmented Monte Carlo localization.
    pub slow_rate: f64,
    /// See [`slow_rate`](Self::slow_rate).
    pub fast_rate: f64,
    /// Recent fit below which the robot is looked for again.
    pub doubtful_fit: f64,
    /// Recent fit below which the robot is lost.
    pub lost_fit: f64,
}

impl Default for LocalizerParams {
    fn default() -> Self {
        Self {
            pixels: PixelLikelihoodParams::default(),
            odometry: OdometryNoise::default(),
            camera: CameraNoise::default(),
            acquisition: AcquisitionParams::default(),
            min_particles: 500,
            max_particles: 1000,
            max_particles_lost: 5000,
            resample_below: 0.5,
            min_pixels: 30,
            withheld: None,
            least_effective: 0.2,
            hidden_views: HiddenViews::default(),
            slow_rate: 0.02,
            fast_rate: 0.3,
            doubtful_fit: 0.1,
            lost_fit: 0.05,
        }
    }
}

impl LocalizerParams {
    pub(crate) fn check(&self) -> Result<(), ColorModelError> {
        self.pixels.check()?;
        for (what, value) in
            self.odometry.values().into_iter().chain(self.camera.values()).chain(self.acquisition.values())
        {
            check(what, value, 0.0, f64::MAX)?;
        }
        for (what, value) in self.hidden_views.values() {
            check(what, value, f64::MIN_POSITIVE, f64::MAX)?;
        }
        check("fewest particles", self.min_particles as f64, 1.0, f64::MAX)?;
        check("most particles", self.max_particles as f64, self.min_particles as f64, f64::MAX)?;
        check("most particles lost", self.max_particles_lost as f64, self.max_particles as f64, f64::MAX)?;
        check("least effective share", self.least_effective, 0.0, 1.0)?;
        check("resample below", self.resample_below, 0.0, 1.0)?;
        check("slow rate", self.slow_rate, 0.0, self.fast_rate)?;
        check("fast rate", self.fast_rate, 0.0, 1.0)?;
        check("doubtful fit", self.doubtful_fit, -1.0, 1.0)?;
        check("fit of a lost robot", self.lost_fit, -1.0, 1.0)
    }
}

fn check(what: &'static str, value: f64, least: f64, most: f64) -> Result<(), ColorModelError> {
    if value >= least && value <= most { Ok(()) } else { Err(ColorModelError::OutOfRange { what, value }) }
}
