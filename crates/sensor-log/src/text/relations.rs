use std::path::Path;

use wayfix_estimation_traits::Pose2;

use super::Lines;
use super::row::{columns, number, stamp};
use crate::{LogError, ReadReport, Stamp};

/// How two poses of a robot truly lie to each other: what the SLAM benchmark of Freiburg judges a trajectory by [Kümmerle et al. 2009].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relation {
    /// When the robot was at the first pose.
    pub from: Stamp,
    /// When it was at the second.
    pub to: Stamp,
    /// The second pose in the frame of the first.
    pub pose: Pose2<f64>,
}

/// Reads `t1 t2 x y z roll pitch yaw` lines: seconds, metres, radians. Height, roll and pitch are passed over.
///
/// The stamps are those of the original log; a log that rounds them differently is met by taking the nearest pose within 10 ms.
///
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
pub fn read_relations(path: impl AsRef<Path>) -> Result<(Vec<Relation>, ReadReport), LogError> {
    let mut relations = Vec::new();
    let mut report = ReadReport::default();
    Lines::open(path.as_ref())?.for_each_row(&mut report, |row| {
        let [from, to, x, y, _, _, _, heading] = columns(row)?;
        let pose = Pose2::new(number(x)?, number(y)?, number(heading)?);
        relations.push(Relation { from: stamp(from)?, to: stamp(to)?, pose });
        Ok(())
    })?;
    Ok((relations, report))
}
