use std::{collections::BTreeMap, path::Path};

use anyhow::{Context, Result, bail, ensure};
use wayfix_sensor_log::read_text;

/// Venue and kind of light of images: a CSV file with the columns `image,venue` or `image,venue,light`.
#[derive(Debug, Default, PartialEq)]
pub(super) struct VenueTable {
    /// The venue of an image, by the name of its file with or without its extension.
    pub(super) venue_of: BTreeMap<String, String>,
    /// The kind of light of a venue, where the file has that column.
    pub(super) light_of: BTreeMap<String, String>,
}

impl VenueTable {
    pub(super) fn read(path: &Path) -> Result<Self> {
        let text = read_text(path).with_context(|| format!("cannot read {}", path.display()))?;
        Self::parse(&text).with_context(|| path.display().to_string())
    }

    fn parse(text: &str) -> Result<Self> {
        let is_content = |(_, line): &(usize, &str)| !line.is_empty() && !line.starts_with('#');
        let lines = text.trim_start_matches('\u{feff}').lines().map(str::trim);
        let mut lines = (1..).zip(lines).filter(is_content);
        let header = lines.next().map(|(_, line)| cells(line)).unwrap_or_default();
        let n_columns = match header[..] {
            ["image", "venue"] => 2,
            ["image", "venue", "light"] => 3,
            _ => bail!("the first line must be `image,venue` or `image,venue,light`"),
        };
        let mut table = Self::default();
        for (number, line) in lines {
            table.add(&cells(line), n_columns).with_context(|| format!("line {number}"))?;
        }
        ensure!(!table.venue_of.is_empty(), "there is no image in it");
        Ok(table)
    }

    fn add(&mut self, cells: &[&str], n_columns: usize) -> Result<()> {
        let n_cells = cells.len();
        ensure!(n_cells == n_columns, "{n_cells} cells, the first line has {n_columns}");
        ensure!(cells.iter().all(|cell| !cell.is_empty()), "an empty cell");
        let (image, venue) = (cells[0], cells[1].to_owned());
        ensure!(self.venue_of.insert(image.to_owned(), venue.clone()).is_none(), "{image} a second time");
        if let Some(light) = cells.get(2) {
            let known = self.light_of.entry(venue.clone()).or_insert_with(|| (*light).to_owned());
            ensure!(known == light, "the venue {venue} has the light {known} before: a venue has one light");
        }
        Ok(())
    }
}

fn cells(line: &str) -> Vec<&str> {
    line.split(',').map(str::trim).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_image_venue_and_light() {
        let table =
            VenueTable::parse("# mine\nimage, venue, light\nr1, lab, sun\nr2.jpg, lab, sun\n").unwrap();
        assert_eq!(table.venue_of["r2.jpg"], "lab");
        assert_eq!(table.light_of["lab"], "sun");
        assert!(VenueTable::parse("image,venue\nr1,lab\n").unwrap().light_of.is_empty());
    }

    #[test]
    fn bad_lines_are_named() {
        for (text, what) in [
            ("", "the first line must be"),
            ("r1,lab\n", "the first line must be"),
            ("image,venue\n", "no image"),
            ("image,venue\nr1\n", "line 2: 1 cells"),
            ("image,venue\nr1,\n", "line 2: an empty cell"),
            ("image,venue\n\nr1,a\nr1,b\n", "line 4: r1 a second time"),
            ("image,venue,light\nr1,a,sun\nr2,a,lamp\n", "line 3: the venue a has the light sun"),
        ] {
            let error = format!("{:#}", VenueTable::parse(text).unwrap_err());
            assert!(error.contains(what), "{text:?}: {error}");
        }
    }
}
