use nalgebra::Vector2;
use wayfix_sensor_log::{Record, RecordData, Stamp};

/// True positions of one point of the robot over time, without headings: a GPS antenna.
#[derive(Clone, Debug, Default)]
pub struct TruePositions {
    fixes: Vec<(Stamp, Vector2<f64>)>,
}

/// Maximum time between a fix and a pose that are compared, s; fixes usually come once a second.
const LONGEST_WAIT: f64 = 0.3;

impl TruePositions {
    /// The true positions among `records`; skips those that are not finite or go back in time.
    pub fn from_records(records: &[Record]) -> Self {
        let mut fixes: Vec<(Stamp, Vector2<f64>)> = Vec::new();
        for record in records {
            if let RecordData::TruePosition(fix) = &record.data {
                let later = fixes.last().is_none_or(|(last, _)| *last < record.stamp);
                if later && fix.x.is_finite() && fix.y.is_finite() {
                    fixes.push((record.stamp, Vector2::new(fix.x, fix.y)));
                }
            }
        }
        Self { fixes }
    }

    /// Last stamp with a fix.
    pub fn last_stamp(&self) -> Option<Stamp> {
        self.fixes.last().map(|(stamp, _)| *stamp)
    }

    /// All fixes.
    pub fn fixes(&self) -> &[(Stamp, Vector2<f64>)] {
        &self.fixes
    }

    /// The fix nearest in time, if within 0.3 s.
    pub fn near(&self, stamp: Stamp) -> Option<Vector2<f64>> {
        let after = self.fixes.partition_point(|(known, _)| *known < stamp);
        let distance = |known: Stamp| known.seconds_since(stamp).abs();
        let neighbours = self.fixes[after.saturating_sub(1)..self.fixes.len().min(after + 1)].iter();
        let (known, position) = neighbours.min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)))?;
        (distance(*known) <= LONGEST_WAIT).then_some(*position)
    }
}

#[cfg(test)]
mod tests {
    use wayfix_sensor_log::TruePosition;

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
