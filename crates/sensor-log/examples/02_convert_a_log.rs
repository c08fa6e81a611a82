//! Converts a log into another format and reads it back.
//!
//! `cargo run -p wayfix-sensor-log --example 02_convert_a_log -- IN OUT FORMAT [ROBOT]`

use std::error::Error;

use wayfix_sensor_log::{LogFormat, LogOpenOptions, convert, open};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, output, format, robot @ ..] = arguments.as_slice() else {
        return Err("give IN, OUT, FORMAT and perhaps ROBOT".into());
    };
    let format: LogFormat = format.parse()?;
    let robot = robot.first().map(|robot| robot.parse()).transpose()?;
    let log = open(input, &LogOpenOptions { robot, ..Default::default() })?;
    let (read, written) = convert(log, output, format)?;
    print!("{read}{written}");

    let back = open(output, &LogOpenOptions { format: Some(format), ..Default::default() })?;
    println!("{} records come back", back.count());
    Ok(())
}
