use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{Drawing, LogError, Record, Shape, topics};

use super::WallSystem;
use crate::{
    slam::draw_stamped_estimate,
    system::{self, EstimateLog, EstimateWriter},
};

/// The map of walls as it is built beside the records, for viewers.
pub type WallEstimateLog = EstimateLog<WallDrawing>;

/// What [`WallEstimateLog`] has drawn so far.
#[derive(Default)]
pub struct WallDrawing {
    n_written: usize,
    path: Vec<Pose2<f64>>,
}

/// The map and the whole path are written with every so many estimates: they change slowly and are long.
const MAP_PERIOD: usize = 20;
const WALL_COLOR: [f64; 4] = [0.84, 0.15, 0.16, 1.0];

impl system::Drawing for WallDrawing {
    type System = WallSystem;

    fn draw(&mut self, _: &Record, system: &WallSystem, writer: &mut EstimateWriter) -> Result<(), LogError> {
        let world = topics::WORLD_FRAME;
        for stamped_estimate in &system.stamped_estimates()[self.n_written..] {
            self.path.push(stamped_estimate.pose);
            draw_stamped_estimate(stamped_estimate, writer)?;
            if self.path.len() % MAP_PERIOD == 1 {
                writer.poses_in_frame("/estimate/path", stamped_estimate.stamp, world, &self.path)?;
                writer.scene_update("/estimate/walls", stamped_estimate.stamp, world, &map(system))?;
            }
        }
        self.n_written = system.stamped_estimates().len();
        Ok(())
    }
}

fn map(system: &WallSystem) -> Vec<Drawing> {
    let drawing =
        |(wall, id): (Vec<[f64; 2]>, String)| Drawing { id, color: WALL_COLOR, shape: Shape::Path(wall) };
    let walls = system.filter().landmarks();
    walls
        .map(|wall| (wall.mean.ends().map(Into::into).to_vec(), format!("wall {}", wall.id)))
        .map(drawing)
        .collect()
}
