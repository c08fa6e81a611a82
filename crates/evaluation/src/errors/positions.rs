use nalgebra::Vector2;
use wayfix_sensor_log::{Record, RecordData, Stamp, TruePosition};

use super::stamped_truth::StampedTruth;

/// True positions of one point of the robot over time, without headings: a GPS antenna.
#[derive(Clone, Debug, Default)]
pub struct TruePositions {
    fixes: StampedTruth<Vector2<f64>>,
}

/// Maximum time between a fix and a pose that are compared, s; fixes usually come once a second.
const LONGEST_WAIT: f64 = 0.3;

impl TruePositions {
    /// The true positions among `records`; skips those that are not finite or go back in time.
    pub fn from_records(records: &[Record]) -> Self {
        let mut positions = Self::default();
        records.iter().for_each(|record| positions.push(record));
        positions
    }

    fn push(&mut self, record: &Record) {
        match record.data {
            RecordData::TruePosition(TruePosition { x, y }) if x.is_finite() && y.is_finite() => {
                self.fixes.push(record.stamp, Vector2::new(x, y));
            }
            _ => {}
        }
    }

    /// Takes the next record of a log. Of a long log only fixes around the stamps of `estimates` are kept, which are those so far.
    pub fn take(&mut self, record: &Record, estimates: impl Iterator<Item = Stamp>) {
        self.push(record);
        self.fixes.thin(record.stamp, estimates);
    }

    /// Last stamp with a fix.
    pub fn last_stamp(&self) -> Option<Stamp> {
        self.fixes.values().last().map(|(stamp, _)| *stamp)
    }

    /// All fixes.
    pub fn fixes(&self) -> &[(Stamp, Vector2<f64>)] {
        self.fixes.values()
    }

    /// The fix nearest in time, if within 0.3 s.
    pub fn near(&self, stamp: Stamp) -> Option<Vector2<f64>> {
        let (after, fixes) = (self.fixes.at_or_after(stamp), self.fixes.values());
        let distance = |known: Stamp| known.seconds_since(stamp).abs();
        let neighbours = fixes[after.saturating_sub(1)..fixes.len().min(after + 1)].iter();
        let (known, position) = neighbours.min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)))?;
        (distance(*known) <= LONGEST_WAIT).then_some(*position)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_fix_counts_and_none_from_afar() {
        let at = |milliseconds: u64| Stamp::from_nanoseconds(milliseconds * 1_000_000);
        let record = |milliseconds: u64| Record {
            stamp: at(milliseconds),
            data: RecordData::TruePosition(TruePosition { x: milliseconds as f64, y: 0.0 }),
        };
        let positions = TruePositions::from_records(&[1000, 1400, 900, 3000].map(record));
        let near = |milliseconds: u64| positions.near(at(milliseconds)).map(|position| position.x);
        assert_eq!(near(1199), Some(1000.0));
        assert_eq!(near(1201), Some(1400.0));
        assert_eq!(near(690), None);
        assert_eq!(near(2000), None);
        assert_eq!(near(3290), Some(3000.0));
        assert_eq!(TruePositions::default().near(at(1)), None);
    }
}
