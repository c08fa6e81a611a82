//! Numbered items of a paper, and the lists of them in marks.

use std::fmt;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    Equation,
    Table,
    Figure,
}

/// Spellings of each kind, plural and singular.
const SPELLINGS: [(Kind, [&str; 2]); 3] = [
    (Kind::Equation, ["Eqs. ", "Eq. "]),
    (Kind::Table, ["Tables ", "Table "]),
    (Kind::Figure, ["Figs. ", "Fig. "]),
];

/// An equation, a table, a figure, or a part of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Item {
    pub(super) kind: Kind,
    pub(super) number: u32,
    /// The `a` of Fig. 1a.
    pub(super) part: Option<char>,
}

impl Item {
    /// Whether a mark with this item speaks of `row`: a whole contains its parts, and a part belongs to its whole.
    pub(super) fn concerns(self, row: Self) -> bool {
        let same_part = self.part.is_none() || row.part.is_none() || self.part == row.part;
        (self.kind, self.number) == (row.kind, row.number) && same_part
    }
}

impl fmt::Display for Item {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self.kind {
            Kind::Equation => "Eq.",
            Kind::Table => "Table",
            Kind::Figure => "Fig.",
        };
        write!(f, "{name} {}{}", self.number, self.part.map(String::from).unwrap_or_default())
    }
}

/// The items in a list such as `Sec. 2, Eqs. 3–5, 9 and Table 1`; what is neither a number nor an item is passed over.
pub(super) fn items(list: &str) -> Vec<Item> {
    let mut kind = None;
    let mut found = Vec::new();
    for piece in list.split([',', ';']).flat_map(|piece| piece.split(" and ")).map(str::trim) {
        let named = SPELLINGS.iter().find_map(|(kind, spellings)| {
            spellings.iter().find_map(|spelling| Some((*kind, piece.strip_prefix(spelling)?)))
        });
        let (kind_of_piece, numbers) = match named {
            Some((named, numbers)) => (Some(named), numbers),
            None => (kind, piece),
        };
        let range = kind_of_piece.and_then(|kind| range(kind, numbers));
        kind = range.is_some().then_some(kind_of_piece).flatten();
        found.extend(range.into_iter().flatten());
    }
    found
}

/// `9`, `1a`, `3–5` or `3-5`.
fn range(kind: Kind, numbers: &str) -> Option<Vec<Item>> {
    if let Some((first, last)) = numbers.split_once(['–', '-']) {
        let (first, last): (u32, u32) = (first.trim().parse().ok()?, last.trim().parse().ok()?);
        return Some((first..=last).map(|number| Item { kind, number, part: None }).collect());
    }
    let digits = numbers.trim_end_matches(|c: char| c.is_ascii_lowercase());
    let mut parts = numbers[digits.len()..].chars();
    let part = parts.next();
    let number = digits.parse().ok().filter(|_| parts.next().is_none())?;
    Some(vec![Item { kind, number, part }])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(list: &str) -> String {
        items(list).iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn ranges_and_lists_are_read() {
        assert_eq!(read("Eqs. 2-4"), "Eq. 2 Eq. 3 Eq. 4");
        assert_eq!(read("Eqs. 3–4, 9"), "Eq. 3 Eq. 4 Eq. 9");
        assert_eq!(read("Eqs. 9, 16"), "Eq. 9 Eq. 16");
        assert_eq!(read("Tables 1 and 2; Figs. 8, 13"), "Table 1 Table 2 Fig. 8 Fig. 13");
        assert_eq!(read("Eq. 20, Fig. 5"), "Eq. 20 Fig. 5");
        assert_eq!(read("Fig. 1a"), "Fig. 1a");
    }

    #[test]
    fn sections_and_words_are_passed_over() {
        assert_eq!(read("Secs. 2.1 and 2.3, Eqs. 11–12"), "Eq. 11 Eq. 12");
        assert_eq!(read("Eq. 28; Swain & Ballard 1991"), "Eq. 28");
        assert_eq!(read("Eq. 3, the inverses put in, 4"), "Eq. 3");
        assert_eq!(read("footnote 1"), "");
    }

    #[test]
    fn a_whole_concerns_its_parts() {
        let only = |list: &str| items(list)[0];
        assert!(only("Fig. 7").concerns(only("Fig. 7a")) && only("Fig. 7a").concerns(only("Fig. 7")));
        assert!(!only("Fig. 7b").concerns(only("Fig. 7a")) && !only("Eq. 7").concerns(only("Fig. 7")));
    }
}
