use anyhow::Result;
use wayfix_appearance_cml::{Panorama, PanoramaDescriptor, PanoramaFeatures, PanoramaParams, TurnSense};
use wayfix_estimation_traits::Pose2;
use wayfix_scene_sim::indoors::{Building, IndoorDrive, IndoorParams};
use wayfix_scene_sim::random::Streams;
use wayfix_scene_sim::route::Route;

/// A simulated drive as a localizer meets it.
#[derive(Clone, Debug)]
pub struct Trip {
    /// View by view.
    pub steps: Vec<TripStep>,
}

/// One view with what the wheels said before it.
#[derive(Clone, Debug)]
pub struct TripStep {
    /// Since the last view; none at the first.
    pub odometry: Option<Pose2<f64>>,
    /// The truth.
    pub pose: Pose2<f64>,
    /// What was seen; nothing when the view was refused, as one right before a single-coloured wall is.
    pub view: Option<PanoramaDescriptor>,
}

impl Trip {
    /// Drives along `route` and describes every view with the default parameters.
    ///
    /// # Errors
    /// When the parameters of the simulation have no meaning.
    pub fn drive(building: &Building, route: Route, params: IndoorParams, streams: Streams) -> Result<Self> {
        let camera = params.camera;
        // As the simulated camera unrolls its views; everything else is the default.
        let params_of_view = PanoramaParams { sense: TurnSense::Clockwise, ..PanoramaParams::default() };
        let features = PanoramaFeatures::new(params_of_view, camera.columns, camera.rings)?;
        let step = |step: wayfix_scene_sim::indoors::IndoorStep| {
            let panorama = Panorama::from_rgb(step.view.width, step.view.height, step.view.rgb)?;
            let view = features.describe(&panorama).ok();
            Ok(TripStep { odometry: step.odometry, pose: step.pose, view })
        };
        Ok(Self {
            steps: IndoorDrive::new(building, route, params, streams)?.map(step).collect::<Result<_>>()?,
        })
    }

    /// Where the robot would be by its odometry alone.
    pub fn dead_reckoning(&self) -> Vec<Pose2<f64>> {
        use wayfix_estimation_traits::LieGroup;
        let Some(first) = self.steps.first() else { return Vec::new() };
        let mut pose = first.pose;
        let mut moved = |step: &TripStep| {
            pose = step.odometry.map_or(pose, |odometry| pose.compose(&odometry));
            pose
        };
        self.steps.iter().map(&mut moved).collect()
    }
}
