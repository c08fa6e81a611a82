use std::path::Path;

use wayfix_estimation_traits::wrap_angle;

use super::{RecordingError, table::Table};

/// A row of a table of poses, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PoseRow {
    pub(super) file: Option<String>,
    /// s.
    pub(super) time: Option<f64>,
    /// m.
    pub(super) x: f64,
    /// m.
    pub(super) y: f64,
    /// rad.
    pub(super) heading: Option<f64>,
}

/// Which column holds what, and how many of its units make the SI unit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Columns {
    file: Option<usize>,
    time: Option<(usize, f64)>,
    x: Option<(usize, f64)>,
    y: Option<(usize, f64)>,
    /// Without a unit where none is named.
    heading: Option<(usize, Option<f64>)>,
}

/// The poses of a table.
///
/// Columns are known by their names (`file frame name image`, `t time stamp`, `x y`, `heading theta yaw phi`; units as `_ms`, `_s`, `_cm`, `_mm`,
/// `_m`, `_deg`), or, without names, by their number: `x,y`, `x,y,heading`, `file,x,y`, `file,x,y,heading`, `t,x,y`, `t,x,y,heading`. Without names
/// three numbers are `t,x,y` where the first grows from row to row by the same amount, give or take half, else `x,y,heading`.
pub(super) fn read(path: &Path, units: Units) -> Result<Vec<PoseRow>, RecordingError> {
    let table = Table::read(path)?;
    poses(&table, units).map_err(|reason| RecordingError::Table { path: path.to_owned(), reason })
}

/// What numbers are in where no name says it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Units {
    /// Of a coordinate, m.
    pub(super) length: f64,
    /// Of a time, s; found from the step of the table when not given.
    pub(super) time: Option<f64>,
}

impl Units {
    /// Metres and seconds, but for tables that are known to be otherwise: the Sussex routes, `…_path_scaled.csv`, are in ms and cm.
    pub(super) fn of(path: &Path) -> Self {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        match name.contains("path_scaled") {
            true => Self { length: 0.01, time: Some(0.001) },
            false => Self { length: 1.0, time: None },
        }
    }
}

fn poses(table: &Table, units: Units) -> Result<Vec<PoseRow>, String> {
    let columns = match &table.names {
        Some(names) => by_name(table, names, units)?,
        None => by_number(table, units)?,
    };
    let column = |column: Option<(usize, f64)>| -> Result<Option<Vec<f64>>, String> {
        let Some((index, unit)) = column else { return Ok(None) };
        Ok(Some(table.numbers(index)?.into_iter().map(|value| value * unit).collect()))
    };
    let (Some(x), Some(y)) = (column(columns.x)?, column(columns.y)?) else {
        return Err("no columns x and y".to_owned());
    };
    let times = column(columns.time)?;
    let headings = match columns.heading {
        Some((index, unit)) => {
            let numbers = table.numbers(index)?;
            let unit = unit.unwrap_or(angle_unit(&numbers));
            Some(numbers.into_iter().map(|value| wrap_angle(value * unit)).collect::<Vec<f64>>())
        }
        None => None,
    };
    let row = |index: usize| PoseRow {
        file: columns.file.map(|column| table.rows[index].1[column].clone()),
        time: times.as_ref().map(|times| times[index]),
        x: x[index],
        y: y[index],
        heading: headings.as_ref().map(|headings| headings[index]),
    };
    Ok((0..table.rows.len()).map(row).collect())
}

fn by_name(table: &Table, names: &[String], units: Units) -> Result<Columns, String> {
    let mut columns = Columns::default();
    for (index, name) in names.iter().enumerate() {
        let mut words = name.split(' ');
        let (word, unit) = (words.next().unwrap_or_default(), words.next_back().unwrap_or_default());
        let length = match unit {
            "mm" => 0.001,
            "cm" => 0.01,
            "m" => 1.0,
            _ => units.length,
        };
        match word {
            "file" | "filename" | "frame" | "name" | "image" | "img" | "path" => columns.file = Some(index),
            "t" | "time" | "stamp" | "timestamp" | "seconds" => {
                let seconds = match unit {
                    "ms" => 0.001,
                    "us" => 1e-6,
                    "ns" => 1e-9,
                    "s" | "sec" | "seconds" => 1.0,
                    _ => match units.time {
                        Some(unit) => unit,
                        None => time_unit(&table.numbers(index)?),
                    },
                };
                columns.time = Some((index, seconds));
            }
            "x" => columns.x = Some((index, length)),
            "y" => columns.y = Some((index, length)),
            "heading" | "theta" | "yaw" | "phi" | "angle" | "orientation" => {
                let unit = match unit {
                    "deg" | "degree" | "degrees" => Some(1_f64.to_radians()),
                    "rad" | "radian" | "radians" => Some(1.0),
                    _ => None,
                };
                columns.heading = Some((index, unit));
            }
            _ => {}
        }
    }
    if columns.x.is_none() || columns.y.is_none() {
        return Err(format!("no columns x and y among {names:?}"));
    }
    Ok(columns)
}

fn by_number(table: &Table, units: Units) -> Result<Columns, String> {
    let n = table.n_columns();
    let file = (0..n).find(|column| !table.is_numeric(*column));
    let numbers: Vec<usize> = (0..n).filter(|column| Some(*column) != file).collect();
    let length = |column: usize| Some((column, units.length));
    let time = |column: usize| -> Result<Option<(usize, f64)>, String> {
        Ok(Some((column, units.time.unwrap_or(time_unit(&table.numbers(column)?)))))
    };
    let angle = |column: usize| Some((column, None));
    let columns = match (file, &numbers[..]) {
        (file, [x, y]) => Columns { file, x: length(*x), y: length(*y), ..Columns::default() },
        (None, [t, x, y]) if is_clock(&table.numbers(*t)?) => {
            Columns { time: time(*t)?, x: length(*x), y: length(*y), ..Columns::default() }
        }
        (file, [x, y, heading]) => {
            Columns { file, x: length(*x), y: length(*y), heading: angle(*heading), ..Columns::default() }
        }
        (file, [t, x, y, heading]) => {
            Columns { file, time: time(*t)?, x: length(*x), y: length(*y), heading: angle(*heading) }
        }
        _ => {
            return Err(format!(
                "{n} columns without names: name them in a first row, as in `file,x_m,y_m,heading_rad`"
            ));
        }
    };
    Ok(columns)
}

/// Whether numbers grow steadily, as stamps do.
fn is_clock(values: &[f64]) -> bool {
    let mut steps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if steps.len() < 2 || steps.iter().any(|step| *step <= 0.0) {
        return false;
    }
    steps.sort_by(f64::total_cmp);
    let median = steps[steps.len() / 2];
    let steady = steps.iter().filter(|step| (0.5 * median..=1.5 * median).contains(*step)).count();
    steady * 10 >= steps.len() * 9
}

/// Turns of more than one are degrees.
fn angle_unit(values: &[f64]) -> f64 {
    if values.iter().any(|value| value.abs() > 7.0) { 1_f64.to_radians() } else { 1.0 }
}

/// Steps of more than 5 are milliseconds, of more than 5000 microseconds, and so on: nothing records a pose only every 5 s.
pub(super) fn time_unit(values: &[f64]) -> f64 {
    let mut steps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    let median = steps.get(steps.len() / 2).copied().unwrap_or(0.0);
    let units = [(5e6, 1e-9), (5e3, 1e-6), (5.0, 1e-3)];
    units.into_iter().find(|(least, _)| median > *least).map_or(1.0, |(_, unit)| unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    const METRES: Units = Units { length: 1.0, time: None };

    fn first(text: &str) -> PoseRow {
        poses(&Table::parse(text).unwrap(), METRES).unwrap().remove(0)
    }

    fn row(file: Option<&str>, time: Option<f64>, heading: Option<f64>) -> PoseRow {
        PoseRow { file: file.map(str::to_owned), time, x: 1.0, y: 2.0, heading }
    }

    #[test]
    fn columns_are_known_by_name_or_number() {
        for (text, expected) in [
            ("1,2\n3,4", row(None, None, None)),
            ("1 2 0.5\n3 4 0.1", row(None, None, Some(0.5))),
            ("1 2 90\n3 4 0.1", row(None, None, Some(std::f64::consts::FRAC_PI_2))),
            ("a.png,1,2\nb.png,3,4", row(Some("a.png"), None, None)),
            ("a.png\t1\t2\t0.5\nb.png\t3\t4\t0", row(Some("a.png"), None, Some(0.5))),
            ("0.1,1,2\n0.2,3,4\n0.3,1,2", row(None, Some(0.1), None)),
            ("0.1,1,2,0.5\n0.2,3,4,0\n0.3,1,2,0", row(None, Some(0.1), Some(0.5))),
            ("y_cm;x;yaw_rad;file\n200;1;0.5;a.png", row(Some("a.png"), None, Some(0.5))),
            ("time [ms],x (m),y (m)\n250,1,2", row(None, Some(0.25), None)),
            ("# frame x y theta_deg\n7 1 2 90", row(Some("7"), None, Some(std::f64::consts::FRAC_PI_2))),
        ] {
            assert_eq!(first(text), expected, "{text:?}");
        }
        let milliseconds = first("33.0,1,2\n66.0,3,4\n99.5,1,2");
        assert!((milliseconds.time.unwrap() - 0.033).abs() < 1e-12);
    }

    #[test]
    fn what_has_no_place_is_refused() {
        for text in ["1\n2", "1,2,3,4,5\n1,2,3,4,5", "x,z\n1,2", "a.png,b.png,1\nc.png,d.png,2"] {
            let refused = Table::parse(text).and_then(|table| poses(&table, METRES));
            assert!(refused.is_err(), "{text:?}: {refused:?}");
        }
    }
}
