use wayfix_color_map::PinholeCamera;

use crate::ColorModelError;

/// How the robot is looked for at the start, and again when it seems to have been carried away.
///
/// One frame is not enough: under a light that is hardly known, some false place explains it better than the true one, with a light to
/// suit. The same light has to explain all frames of a while, and of those the false place cannot make sense. So the last frames are kept, and
/// whole trajectories are weighed by all of them at once under one light. The likelihood is narrow, hence the trajectories are drawn near to its
/// peaks: drawn where landmarks would be seen as they are, gathered into places, and moved by steps that grow with success and shrink with failure
/// [Rechenberg 1973], while of the places only the better go on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct AcquisitionParams {
    /// Frames that are kept. At the start the robot is looked for after 1, 2, 4, ... frames, up to this number.
    pub n_frames: usize,
    /// Frames until the robot is looked for again even if nothing is doubted: a wrong place may explain what is seen quite well, and only
    /// another that does so better gives it away. Half as many while the fit leaves doubts; twice and four times as many when searches in a row
    /// confirmed the place and the fit is as good as usual. 0 for never.
    pub every: usize,
    /// Most of them that trajectories are weighed by, evenly spread.
    pub n_weighed: usize,
    /// Places that are pursued when the robot was looked for, each by particles of its own. With every frame there is one fewer.
    pub n_kept: usize,
    /// Places that are pursued for as long as the frames have not decided between them.
    pub n_undecided: usize,
    /// A place is given up when the frames make it this much less likely than the best, nats.
    pub hopeless: f64,
    /// By how much the frames have to make another place more likely than the one where the robot believes to be, when that is doubted, nats: it
    /// is carried away in one of thousands of frames, and then may be in any of some hundred thousand places. The frames of a search count beyond twice as
    /// many, since a place chosen among thousands is flattered by them.
    pub elsewhere: f64,
    /// A place is pursued beside the one where the robot believes to be if the frames of a search make it at most this much less likely, nats.
    pub margin: f64,
    /// The robot is looked for in images of which squares of this many pixels a side are averaged to one.
    pub shrink: u32,
    /// Pixels left out at both ends of each span of the shrunk images.
    pub edge_margin: u16,
    /// Trajectories that are drawn at first.
    pub n_drawn: usize,
    /// Frames that those are weighed by.
    pub n_coarse: usize,
    /// Places that are looked at more closely.
    pub n_niches: usize,
    /// Trajectories of the passes after it.
    pub n_particles: usize,
    /// Passes after the first.
    pub n_passes: u32,
    /// Steps that each tries in a pass.
    pub n_moves: usize,
    /// A pass is softened until this share of the trajectories is effective.
    pub least_effective: f64,
    /// Standard deviation of the first steps, metres.
    pub reach: f64,
    /// The same for the heading, radians.
    pub turn: f64,
}

impl Default for AcquisitionParams {
    fn default() -> Self {
        Self {
            n_frames: 16,
            every: 10,
            n_weighed: 8,
            n_kept: 12,
            n_undecided: 4,
            hopeless: 60.0,
            elsewhere: 40.0,
            margin: 20.0,
            shrink: 2,
            edge_margin: 1,
            n_drawn: 4000,
            n_coarse: 3,
            n_niches: 100,
            n_particles: 150,
            n_passes: 6,
            n_moves: 10,
            least_effective: 0.2,
            reach: 0.15,
            turn: 0.15,
        }
    }
}

impl AcquisitionParams {
    pub(crate) fn values(&self) -> [(&'static str, f64); 6] {
        [
            ("nats of a hopeless place", self.hopeless),
            ("lead of the place believed in, nats", self.elsewhere),
            ("margin of a place to pursue, nats", self.margin),
            ("least effective share of a pass", self.least_effective),
            ("reach of a pass (m)", self.reach),
            ("turn of a pass (rad)", self.turn),
        ]
    }

    /// The camera of the shrunk images.
    pub(crate) fn camera(&self, camera: &PinholeCamera) -> Result<PinholeCamera, ColorModelError> {
        let (what, value) = ("shrinking of images", f64::from(self.shrink));
        camera.shrunk(self.shrink).map_err(|_| ColorModelError::OutOfRange { what, value })
    }

    /// How closely a pass looks: at few frames in the first third.
    pub(crate) fn effort(&self, pass: u32) -> Effort {
        if 3 * pass < self.n_passes { Effort::Coarse } else { Effort::Full }
    }

    /// Whether a pass is the first that looks at all frames.
    pub(crate) fn is_first_full(&self, pass: u32) -> bool {
        let is_full = |pass: u32| self.effort(pass) == Effort::Full;
        is_full(pass) && !pass.checked_sub(1).is_some_and(is_full)
    }

    /// Whether a pass looks for errors of odometry and camera too.
    pub(crate) fn is_fine(&self, pass: u32) -> bool {
        3 * pass >= 2 * self.n_passes
    }

    /// Size of the steps after a pass, as a share of those after the first.
    pub(crate) fn scale(&self, pass: u32) -> f64 {
        0.1_f64.powf(f64::from(pass) / f64::from(self.n_passes.max(2) - 1))
    }
}

/// How closely candidates are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Effort {
    /// By a few of the frames.
    Coarse,
    /// By all of them.
    Full,
}
