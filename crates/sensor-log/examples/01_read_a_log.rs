//! Says what a log holds, then follows the robot's true path.
//!
//! `cargo run -p wayfix-sensor-log --example 01_read_a_log -- PATH [ROBOT]`

use std::error::Error;

use wayfix_sensor_log::{LogOpenOptions, LogSummary, RecordData, open};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("give the path of a log")?;
    let robot = arguments.next().map(|robot| robot.parse()).transpose()?;
    let options = LogOpenOptions { robot, ..Default::default() };

    print!("{}", LogSummary::of(open(&path, &options)?));

    let mut length = 0.0;
    let mut previous = None;
    for record in open(&path, &options)? {
        if let RecordData::TruePose(pose) = record.data {
            let (x, y) = previous.unwrap_or((pose.x(), pose.y()));
            length += f64::hypot(pose.x() - x, pose.y() - y);
            previous = Some((pose.x(), pose.y()));
        }
    }
    println!("true path: {length:.2} m");
    Ok(())
}
