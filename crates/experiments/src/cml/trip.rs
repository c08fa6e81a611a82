use anyhow::Result;
use wayfix_appearance_cml::{
    AzimuthDirection, Panorama, PanoramaDescriptor, PanoramaDescriptorExtractor, PanoramaDescriptorParams,
};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_scene_sim::indoors::{Building, IndoorDrive, IndoorDriveParams, IndoorDriveStep};
use wayfix_scene_sim::random::RandomStreams;
use wayfix_scene_sim::route::Route;

/// A simulated drive as a localizer meets it.
#[derive(Clone, Debug)]
pub(crate) struct SimulatedDrive {
    /// View by view.
    pub steps: Vec<SimulatedDriveStep>,
}

/// One view with the odometry before it.
#[derive(Clone, Debug)]
pub(crate) struct SimulatedDriveStep {
    /// Since the last view; none at the first.
    pub odometry: Option<Pose2<f64>>,
    /// The truth.
    pub pose: Pose2<f64>,
    /// The descriptor of the view; `None` if it was refused, as in front of a uniform wall.
    pub view: Option<PanoramaDescriptor>,
}

impl SimulatedDrive {
    /// Drives along `route` and describes every view with the default parameters.
    ///
    /// # Errors
    /// Returns an error if a parameter of the simulation is out of range.
    pub(crate) fn drive(
        building: &Building,
        route: Route,
        params: IndoorDriveParams,
        streams: RandomStreams,
    ) -> Result<Self> {
        let camera = params.camera;
        // As the simulated camera unrolls its views; everything else is the default.
        let params_of_view = PanoramaDescriptorParams {
            azimuth_direction: AzimuthDirection::Clockwise,
            ..PanoramaDescriptorParams::default()
        };
        let features = PanoramaDescriptorExtractor::new(params_of_view, camera.n_columns, camera.n_rings)?;
        let step = |step: IndoorDriveStep| {
            let panorama = Panorama::from_rgb(step.view.width, step.view.height, step.view.rgb)?;
            let view = features.describe(&panorama).ok();
            Ok(SimulatedDriveStep { odometry: step.odometry, pose: step.pose, view })
        };
        Ok(Self {
            steps: IndoorDrive::new(building, route, params, streams)?.map(step).collect::<Result<_>>()?,
        })
    }

    /// Dead-reckoned poses.
    pub(crate) fn dead_reckoning(&self) -> Vec<Pose2<f64>> {
        let Some(first) = self.steps.first() else { return Vec::new() };
        let mut pose = first.pose;
        let mut moved = |step: &SimulatedDriveStep| {
            pose = step.odometry.map_or(pose, |odometry| pose.compose(&odometry));
            pose
        };
        self.steps.iter().map(&mut moved).collect()
    }
}

#[cfg(test)]
mod tests {
    use wayfix_appearance_cml::ViewDescriptor;
    use wayfix_estimation_traits::wrap_angle;

    use super::super::worlds::{Draw, tour};
    use super::*;

    const SEED: u64 = 3;

    #[test]
    fn views_turn_with_the_robot() {
        let building = wayfix_scene_sim::indoors::Laboratory::draw(&mut Draw::World.rng(SEED)).building();
        let trip = tour(&building, 60.0, IndoorDriveParams::default(), (SEED, 0)).unwrap();
        let mut off: Vec<f64> = trip
            .steps
            .windows(2)
            .filter_map(|pair| {
                let turned = wrap_angle(pair[1].pose.heading() - pair[0].pose.heading());
                let seen = pair[1].view.as_ref()?.compare(pair[0].view.as_ref()?).rotation;
                (turned.abs() > 0.2).then(|| wrap_angle(seen - turned).abs())
            })
            .collect();
        off.sort_by(f64::total_cmp);
        assert!(off.len() > 20, "{} turning steps", off.len());
        // Half a column is 1.5°; parallax over a step of 0.25 m, 1 m from a wall, moves single objects by up to 14°. A mirrored view would give at
        // least twice the turn, 23°.
        assert!(off[off.len() / 2].to_degrees() < 7.0, "{}", off[off.len() / 2].to_degrees());
    }

    #[test]
    fn odometry_drifts_and_starts_at_the_truth() {
        let building = wayfix_scene_sim::indoors::Laboratory::draw(&mut Draw::World.rng(SEED)).building();
        let trip = tour(&building, 60.0, IndoorDriveParams::default(), (SEED, 0)).unwrap();
        let reckoned = trip.dead_reckoning();
        let errors: Vec<f64> = trip
            .steps
            .iter()
            .zip(&reckoned)
            .map(|(step, pose)| (step.pose.translation - pose.translation).norm())
            .collect();
        assert_eq!(errors[0], 0.0);
        // Slip turns the robot by 0.115° on the first metre and by 0.9° over 60 m, in a room of 15 m.
        let end = errors[errors.len() - 1];
        assert!((1e-3..1.0).contains(&end), "{end}");
    }
}
