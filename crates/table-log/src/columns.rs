use std::str::FromStr;

use crate::table::{Table, plain};

/// Quantity of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Quantity {
    File,
    Time,
    X,
    Y,
    Heading,
}

/// A column of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Column {
    pub(super) index: usize,
    /// Factor to SI units.
    pub(super) factor: f64,
    pub(super) unit: &'static str,
    /// Whether the unit is assumed rather than stated in the name.
    pub(super) is_assumed: bool,
}

/// The names of the columns of a table without a header, as in `t_ms,x_cm,y_cm`.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseTableColumns(Vec<String>);

impl FromStr for PoseTableColumns {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let names: Vec<String> = text.split(',').map(plain).collect();
        match names.iter().any(|name| meaning(name).is_some()) {
            true => Ok(Self(names)),
            false => Err(format!("none of the names is known: {KNOWN}")),
        }
    }
}

/// The recognized columns of a table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Columns {
    found: Vec<(Quantity, String, Column)>,
    names: Vec<String>,
}

pub(super) const KNOWN: &str =
    "file, t_s (_ms, _us, _ns), x_m (_cm, _mm), y_m, heading_rad (theta, yaw; _deg)";

impl Columns {
    /// Reads the column names from the header of the table, or from `given`.
    pub(super) fn of(table: &Table, given: Option<&PoseTableColumns>, option: &str) -> Result<Self, String> {
        let n = table.n_columns();
        let Some(names) = given.map(|given| &given.0).or(table.names.as_ref()) else {
            return Err(format!(
                "{n} columns without names: name them with {option}, as in t_ms,x_cm,y_cm, or in a first row; known are {KNOWN}"
            ));
        };
        if names.len() != n {
            return Err(format!("{} names ({}) for {n} columns", names.len(), names.join(", ")));
        }
        let mut found: Vec<(Quantity, String, Column)> = Vec::new();
        for (index, name) in names.iter().enumerate() {
            let Some((quantity, unit)) = meaning(name) else { continue };
            if let Some((_, other, _)) = found.iter().find(|(known, ..)| *known == quantity) {
                return Err(format!("the columns {other:?} and {name:?} hold the same"));
            }
            let (unit, factor) = unit.unwrap_or(quantity.si());
            let is_assumed = quantity != Quantity::File && words(name).1.is_none();
            found.push((quantity, name.clone(), Column { index, factor, unit, is_assumed }));
        }
        Ok(Self { found, names: names.clone() })
    }

    pub(super) fn get(&self, quantity: Quantity) -> Option<Column> {
        self.found.iter().find(|(known, ..)| *known == quantity).map(|(.., column)| *column)
    }

    /// Returns a required column.
    pub(super) fn need(&self, quantity: Quantity, name: &str) -> Result<Column, String> {
        self.get(quantity)
            .ok_or_else(|| format!("no column {name} among {}; known are {KNOWN}", self.names.join(", ")))
    }

    /// Units as `t in ms, x in cm`, of the columns with stated or with assumed units.
    pub(super) fn units(&self, is_assumed: bool) -> Option<String> {
        let with_unit = self
            .found
            .iter()
            .filter(|(quantity, _, column)| *quantity != Quantity::File && column.is_assumed == is_assumed);
        let texts: Vec<String> =
            with_unit.map(|(_, name, column)| format!("{name:?} in {}", column.unit)).collect();
        (!texts.is_empty()).then(|| texts.join(", "))
    }
}

type Unit = (&'static str, f64);

impl Quantity {
    fn si(self) -> Unit {
        match self {
            Self::File => ("", 1.0),
            Self::Time => ("s", 1.0),
            Self::X | Self::Y => ("m", 1.0),
            Self::Heading => ("rad", 1.0),
        }
    }

    fn has(self, unit: &str) -> bool {
        match self {
            Self::File => false,
            Self::Time => ["s", "ms", "us", "ns"].contains(&unit),
            Self::X | Self::Y => ["m", "cm", "mm"].contains(&unit),
            Self::Heading => ["rad", "deg"].contains(&unit),
        }
    }
}

/// A name without its unit, and the unit.
fn words(name: &str) -> (&str, Option<Unit>) {
    let (base, last) = name.rsplit_once(' ').unwrap_or((name, ""));
    let unit = match last {
        "s" | "sec" | "secs" | "second" | "seconds" => ("s", 1.0),
        "ms" | "msec" | "millisecond" | "milliseconds" => ("ms", 1e-3),
        "us" | "µs" | "μs" | "usec" | "microsecond" | "microseconds" => ("us", 1e-6),
        "ns" | "nsec" | "nanosecond" | "nanoseconds" => ("ns", 1e-9),
        "m" | "meter" | "meters" | "metre" | "metres" => ("m", 1.0),
        "cm" | "centimeters" | "centimetres" => ("cm", 0.01),
        "mm" | "millimeters" | "millimetres" => ("mm", 0.001),
        "rad" | "radian" | "radians" => ("rad", 1.0),
        "deg" | "degree" | "degrees" => ("deg", 1_f64.to_radians()),
        _ => return (name, None),
    };
    (base, Some(unit))
}

/// Quantity of a column of this name, and its unit if the name states it.
fn meaning(name: &str) -> Option<(Quantity, Option<Unit>)> {
    let (base, unit) = words(name);
    let quantity = match base {
        "file" | "filename" | "file name" | "frame" | "name" | "image" | "img" | "path" => Quantity::File,
        "t" | "time" | "stamp" | "timestamp" | "time stamp" | "seconds" | "sec" => Quantity::Time,
        "x" | "pos x" | "position x" | "pose x" => Quantity::X,
        "y" | "pos y" | "position y" | "pose y" => Quantity::Y,
        "heading" | "theta" | "yaw" | "phi" | "angle" | "orientation" => Quantity::Heading,
        _ => return None,
    };
    match unit {
        Some((unit, _)) if !quantity.has(unit) => None,
        _ => Some((quantity, unit)),
    }
}
