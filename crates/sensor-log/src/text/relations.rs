use std::path::Path;

use wayfix_estimation_traits::Pose2;

use super::Lines;
use super::row::{columns, number, stamp};
use crate::{LogError, ReadReport, Stamp};

/// True relative pose of two robot poses: the SLAM benchmark of Freiburg scores trajectories by these [Kümmerle et al. 2009].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseRelation {
    /// Stamp of the first pose.
    pub from: Stamp,
    /// Stamp of the second pose.
    pub to: Stamp,
    /// The second pose in the frame of the first.
    pub pose: Pose2<f64>,
}

/// Reads lines `t1 t2 x y z roll pitch yaw`: seconds, metres, radians. Ignores height, roll and pitch.
///
/// The stamps are those of the original log; for logs with other rounding, use the nearest pose within 10 ms.
/// ```
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("intel.relations");
/// std::fs::write(&path, "10.5 12.5 0.35 -0.01 0 0 0 -0.02\n10.5 13\n")?;
/// let (relations, report) = wayfix_sensor_log::read_relations(&path)?;
/// assert_eq!(relations[0].to.seconds_since(relations[0].from), 2.0);
/// assert_eq!((relations[0].pose.x(), relations[0].pose.heading()), (0.35, -0.02));
/// assert_eq!(report.n_problems(), 1); // the second line breaks off
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Returns an error if the file cannot be read. Single bad lines are in the report.
pub fn read_relations(path: impl AsRef<Path>) -> Result<(Vec<PoseRelation>, ReadReport), LogError> {
    let mut relations = Vec::new();
    let mut report = ReadReport::default();
    Lines::open(path.as_ref())?.for_each_row(&mut report, |row| {
        let [from, to, x, y, _, _, _, heading] = columns(row)?;
        let pose = Pose2::new(number(x)?, number(y)?, number(heading)?);
        relations.push(PoseRelation { from: stamp(from)?, to: stamp(to)?, pose });
        Ok(())
    })?;
    Ok((relations, report))
}
