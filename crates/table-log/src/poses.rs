use std::path::Path;

use wayfix_estimation_traits::wrap_angle;
use wayfix_sensor_log::ReadReport;

use crate::{
    RecordingError,
    columns::{Column, Columns, PoseTableColumns, Quantity},
    table::Table,
};

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

/// The poses of a table, `None` for each unusable row. The report lists these rows and the assumed units.
///
/// Column names come from the header, or from `names` for a table without one. The unit comes from the name; the default is SI.
pub(crate) fn read(
    path: &Path,
    names: Option<&PoseTableColumns>,
    report: &mut ReadReport,
    notes: &mut Vec<String>,
) -> Result<Vec<Option<PoseRow>>, RecordingError> {
    let table = Table::read(path, report)?;
    let refused = |reason| RecordingError::Table { path: path.to_owned(), reason };
    let columns = Columns::of(&table, names, "--columns").map_err(refused)?;
    let rows = poses(&table, &columns, report).map_err(refused)?;
    table.say_units(&columns, "--columns", report, notes);
    Ok(rows)
}

fn poses(table: &Table, columns: &Columns, report: &mut ReadReport) -> Result<Vec<Option<PoseRow>>, String> {
    let (x, y) = (columns.need(Quantity::X, "x")?, columns.need(Quantity::Y, "y")?);
    let (time, heading) = (columns.get(Quantity::Time), columns.get(Quantity::Heading));
    let file = columns.get(Quantity::File);
    let mut rows = Vec::with_capacity(table.rows.len());
    for (line, cells) in &table.rows {
        let optional = |column: Option<Column>| column.map(|column| table.number(cells, column)).transpose();
        let row = || -> Result<PoseRow, String> {
            table.check_width(cells)?;
            Ok(PoseRow {
                file: file.and_then(|column| cells.get(column.index)).cloned(),
                time: optional(time)?,
                x: table.number(cells, x)?,
                y: table.number(cells, y)?,
                heading: optional(heading)?.map(wrap_angle),
            })
        };
        rows.push(row().map_err(|reason| table.leave_out(*line, reason, report)).ok());
    }
    match rows.iter().any(Option::is_some) {
        true => Ok(rows),
        false => Err(format!("none of {} rows is a pose; {}", rows.len(), table.first_problem(report))),
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    fn read_text(text: &str, names: Option<&str>) -> Result<(Vec<Option<PoseRow>>, Columns), String> {
        let table = Table::parse(text)?;
        let names = names.map(|names| names.parse::<PoseTableColumns>()).transpose()?;
        let columns = Columns::of(&table, names.as_ref(), "--columns")?;
        Ok((poses(&table, &columns, &mut ReadReport::default())?, columns))
    }

    fn first(text: &str, names: Option<&str>) -> PoseRow {
        read_text(text, names).unwrap().0.remove(0).unwrap()
    }

    #[test]
    fn columns_are_known_by_their_names_and_units() {
        let row = |file: Option<&str>, time, heading| PoseRow {
            file: file.map(str::to_owned),
            time,
            x: 1.0,
            y: 2.0,
            heading,
        };
        for (text, names, expected) in [
            ("1,2\n3,4", Some("x,y"), row(None, None, None)),
            ("1 2 90\n3 4 0.1", Some("x,y,yaw_deg"), row(None, None, Some(FRAC_PI_2))),
            ("a.png,1,2\nb.png,3,4", Some("file,x_m,y_m"), row(Some("a.png"), None, None)),
            ("250,100,200\n500,1,2", Some("t_ms,x_cm,y_cm"), row(None, Some(0.25), None)),
            ("y_cm;x;yaw_rad;file\n200;1;0.5;a.png", None, row(Some("a.png"), None, Some(0.5))),
            ("\u{feff}time [ms],x (m),y (m)\n250,1,2", None, row(None, Some(0.25), None)),
            ("# frame x y theta_deg\n7 1 2 90", None, row(Some("7"), None, Some(FRAC_PI_2))),
            ("x\ty\theading [degrees]\n1\t2\t90", None, row(None, None, Some(FRAC_PI_2))),
            ("x_m,lowest difference,y_m\n1,7,2", None, row(None, None, None)),
        ] {
            assert_eq!(first(text, names), expected, "{text:?}");
        }
    }

    #[test]
    fn unwrapped_radians_stay_radians_and_are_said() {
        let (rows, columns) = read_text("x_m,y_m,theta\n1,2,13.8\n3,4,14", None).unwrap();
        let heading = rows[0].as_ref().unwrap().heading.unwrap();
        assert_abs_diff_eq!(heading, 13.8 - 2.0 * std::f64::consts::TAU, epsilon = 1e-12);
        assert_eq!(columns.units(true).unwrap(), "\"theta\" in rad");
        assert_eq!(columns.units(false).unwrap(), "\"x m\" in m, \"y m\" in m");
    }

    #[test]
    fn missing_names_and_unknown_units_are_refused_by_name() {
        let error = |text: &str| read_text(text, None).unwrap_err();
        assert!(error("1,2\n3,4").contains("--columns"));
        let found = error("time [s],best heading [degrees],filename\n1,2,a.png");
        assert!(found.contains("no column x among") && found.contains("best heading degrees"), "{found}");
        assert!(error("x_ft,y_ft\n1,2").contains("x ft"));
        assert!(error("x_m,x_cm,y_m\n1,2,3").contains("hold the same"));
    }

    #[test]
    fn nan_and_short_rows_keep_their_place_empty() {
        let text = "file,x_m,y_m\na.png,1,2\nb.png,nan,2\nc.png,1\nd.png,1,2";
        let (rows, _) = read_text(text, None).unwrap();
        let usable: Vec<bool> = rows.iter().map(Option::is_some).collect();
        assert_eq!(usable, [true, false, false, true]);
    }
}
