use std::path::Path;

use wayfix_estimation_traits::wrap_angle;

use super::{
    RecordingError,
    stamps::file_name,
    table::{Column, Table, number},
};

/// A row of a table of poses, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PoseRow {
    /// Its place among the rows of the table, those that cannot be used counted.
    pub(super) ordinal: usize,
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

/// The poses of a table, and how it was read.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Poses {
    pub(super) rows: Vec<PoseRow>,
    /// Lines that were left out, and why.
    pub(super) problems: Vec<(usize, String)>,
    /// What columns were read, in which units.
    pub(super) columns: String,
    /// Columns whose names say no unit.
    pub(super) assumed: Vec<String>,
}

pub(super) const FILE: [&str; 7] = ["file", "filename", "frame", "name", "image", "img", "path"];
pub(super) const TIME: [&str; 5] = ["t", "time", "stamp", "timestamp", "seconds"];
const HEADING: [&str; 6] = ["heading", "theta", "yaw", "phi", "angle", "orientation"];

/// A unit by its name, and how many of the SI unit it is.
type Unit = (&'static str, f64);

const LENGTHS: [Unit; 3] = [("m", 1.0), ("cm", 0.01), ("mm", 0.001)];
pub(super) const TIMES: [Unit; 6] =
    [("s", 1.0), ("sec", 1.0), ("seconds", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)];
const DEGREE: f64 = std::f64::consts::PI / 180.0;
const ANGLES: [Unit; 6] = [
    ("rad", 1.0),
    ("radian", 1.0),
    ("radians", 1.0),
    ("deg", DEGREE),
    ("degree", DEGREE),
    ("degrees", DEGREE),
];

/// The poses of a table.
///
/// Columns are known by their names: `file frame name image`, `t time stamp`, `x y`, `heading theta yaw phi`, with units as in `t_ms`, `x_cm`,
/// `yaw_deg`. Without a unit they are in s, m and rad. `names` are those of a table without a row of names.
pub(super) fn read(path: &Path, names: Option<&[String]>) -> Result<Poses, RecordingError> {
    let table = Table::read(path, names)?;
    poses(&table).map_err(|reason| RecordingError::Table { path: path.to_owned(), reason })
}

/// The factor of a column's unit, the first of `units` where its name says none; whether it was assumed.
pub(super) fn unit_of(column: Column<'_>, units: &[Unit]) -> (Unit, bool) {
    let named = units.iter().find(|(name, _)| *name == column.unit);
    (named.copied().unwrap_or(units[0]), named.is_none())
}

fn poses(table: &Table) -> Result<Poses, String> {
    let (Some(x), Some(y)) = (table.column(&["x"]), table.column(&["y"])) else {
        return Err(format!(
            "no columns x and y among {:?}; needed are x, y and one of file or t",
            table.names
        ));
    };
    let (file, time, heading) = (table.column(&FILE), table.column(&TIME), table.column(&HEADING));
    let with_unit = |column: Option<Column<'_>>, units: &[Unit]| {
        column.map(|column| (column.index, unit_of(column, units)))
    };
    let measured = [
        with_unit(time, &TIMES),
        with_unit(Some(x), &LENGTHS),
        with_unit(Some(y), &LENGTHS),
        with_unit(heading, &ANGLES),
    ];
    let factor = |which: usize| measured[which].map_or(1.0, |(_, ((_, factor), _))| factor);
    let mut lines: Vec<usize> = table.rows.iter().map(|(line, _)| *line).collect();
    lines.extend(table.problems.iter().map(|(line, _)| *line));
    lines.sort_unstable();
    let pose = |line: usize, row: &[String]| -> Result<PoseRow, String> {
        let optional = |column: Option<Column<'_>>, which: usize| {
            column.map(|column| Ok::<f64, String>(number(row, column)? * factor(which))).transpose()
        };
        Ok(PoseRow {
            ordinal: lines.partition_point(|other| *other < line),
            file: file.map(|column| file_name(&row[column.index])),
            time: optional(time, 0)?,
            x: number(row, x)? * factor(1),
            y: number(row, y)? * factor(2),
            heading: optional(heading, 3)?.map(wrap_angle),
        })
    };
    let (mut rows, mut problems) = (Vec::new(), table.problems.clone());
    for (line, row) in &table.rows {
        match pose(*line, row) {
            Ok(row) => rows.push(row),
            Err(reason) => problems.push((*line, reason)),
        }
    }
    problems.sort();
    if let (true, Some((line, reason))) = (rows.is_empty(), problems.first()) {
        return Err(format!("no row can be used; line {line}: {reason}"));
    }
    let described =
        |(index, ((unit, _), _)): &(usize, (Unit, bool))| format!("{} in {unit}", table.names[*index]);
    let assumed =
        measured.iter().flatten().filter(|(_, (_, is_assumed))| *is_assumed).map(described).collect();
    let columns = measured.iter().flatten().map(described).collect::<Vec<_>>().join(", ");
    Ok(Poses { rows, problems, columns, assumed })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Poses {
        poses(&Table::parse(text, None).unwrap()).unwrap()
    }

    fn row(file: Option<&str>, time: Option<f64>, heading: Option<f64>) -> PoseRow {
        PoseRow { ordinal: 0, file: file.map(str::to_owned), time, x: 1.0, y: 2.0, heading }
    }

    #[test]
    fn columns_are_known_by_name_and_unit() {
        let right = Some(std::f64::consts::FRAC_PI_2);
        for (text, expected) in [
            ("x,y\n1,2\n3,4", row(None, None, None)),
            ("file,x,y,theta\na.png,1,2,0.5", row(Some("a.png"), None, Some(0.5))),
            ("y_cm;x;yaw_rad;file\n200;1;0.5;b/a.png", row(Some("a.png"), None, Some(0.5))),
            ("time [ms],x (m),y (m)\n250,1,2", row(None, Some(0.25), None)),
            ("# frame x y theta_deg\n7 1 2 90", row(Some("7"), None, right)),
            ("x,y,heading [degrees]\n1,2,90", row(None, None, right)),
        ] {
            assert_eq!(parsed(text).rows[0], expected, "{text:?}");
        }
    }

    #[test]
    fn heading_without_a_unit_is_in_radians_of_any_size() {
        let found = parsed("x_m,y_m,theta\n1,2,13.8\n1,2,0.1");
        let heading = found.rows[0].heading.unwrap();
        assert!((heading - wrap_angle(13.8)).abs() < 1e-12, "{heading}");
        assert_eq!(found.assumed, ["theta in rad"]);
        assert_eq!(found.columns, "x m in m, y m in m, theta in rad");
    }

    #[test]
    fn rows_with_no_number_are_left_out_with_their_lines() {
        let found = parsed("x,y\n1,2\nnan,3\n5\n7,8");
        assert_eq!(found.rows.iter().map(|row| row.ordinal).collect::<Vec<_>>(), [0, 3]);
        assert_eq!(found.problems.iter().map(|(line, _)| *line).collect::<Vec<_>>(), [3, 4]);
    }

    #[test]
    fn table_of_something_else_names_its_columns() {
        let text = "Time [s], Best heading [degrees], Lowest difference, Filename\n1,2,3,a.png";
        let error = poses(&Table::parse(text, None).unwrap()).unwrap_err();
        assert!(error.contains("best heading degrees") && error.contains("no columns x and y"), "{error}");
    }
}
