//! Makes a long log of a short one: the robot drives it forward, backward, forward, … until the hours are over.
//!
//! `cargo run -p wayfix-sensor-log --example 05_long_log -- IN OUT.mcap HOURS`

use std::error::Error;

use wayfix_estimation_traits::LieGroup;
use wayfix_sensor_log::{LogFormat, LogOpenOptions, Record, RecordData, Stamp, Velocity, open, write};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, output, hours] = arguments.as_slice() else {
        return Err("give IN, OUT.mcap and HOURS".into());
    };
    let (forward, _) = open(input, &LogOpenOptions::default())?.read_all();
    let (Some(first), Some(last)) = (forward.first(), forward.last()) else {
        return Err("the log is empty".into());
    };
    let (first, last) = (first.stamp.nanoseconds(), last.stamp.nanoseconds());
    let backward = backward(&forward, first + last);
    let end = first + (hours.parse::<f64>()? * 3600.0 * 1e9) as u64;
    let shifted = |(pass, records): (u64, &Vec<Record>)| {
        let by = pass * (last - first);
        let shift = move |record: &Record| Record {
            stamp: Stamp::from_nanoseconds(record.stamp.nanoseconds() + by),
            data: record.data.clone(),
        };
        let is_known = |record: &&Record| {
            pass > 0 && matches!(record.data, RecordData::TrueLandmark(_) | RecordData::TrueWall(_))
        };
        records.iter().filter(|record| !is_known(record)).map(shift).collect::<Vec<_>>()
    };
    let passes = (0..).zip([&forward, &backward].into_iter().cycle());
    let records = passes.flat_map(shifted).take_while(|record| record.stamp.nanoseconds() <= end);
    print!("{}", write(output, LogFormat::Mcap, records)?);
    Ok(())
}

/// The records of the way back: the robot leaves each place by the inverse of the motion that led to it. `ends` is the sum of the first and
/// the last stamp.
fn backward(forward: &[Record], ends: u64) -> Vec<Record> {
    let mut records: Vec<Record> = Vec::with_capacity(forward.len());
    let mut last_increment = forward[0].stamp;
    let mut last_velocity = None;
    for Record { stamp, data } in forward {
        let (stamp, data) = match data {
            RecordData::OdometryIncrement(motion) => (
                std::mem::replace(&mut last_increment, *stamp),
                Some(RecordData::OdometryIncrement(motion.inverse())),
            ),
            RecordData::Velocity(velocity) => {
                (*stamp, last_velocity.replace(*velocity).map(reversed).map(RecordData::Velocity))
            }
            data => (*stamp, Some(data.clone())),
        };
        let stamp = Stamp::from_nanoseconds(ends - stamp.nanoseconds());
        records.extend(data.map(|data| Record { stamp, data }));
    }
    // What leads to a stamp comes before what is seen then.
    let is_seen =
        |data: &RecordData| !matches!(data, RecordData::OdometryIncrement(_) | RecordData::Velocity(_));
    records.sort_by_key(|record| (record.stamp, is_seen(&record.data)));
    records
}

fn reversed(velocity: Velocity) -> Velocity {
    Velocity { linear: -velocity.linear, angular: -velocity.angular }
}
