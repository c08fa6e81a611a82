use std::ops::Range;

use toml::de::{DeTable, DeValue, Error};

/// The line, from 1, of the key in a TOML text for which `parse` gives this error message.
///
/// Parameters are read over defaults, which loses the place of a key in the text.
pub(super) fn refused_line<P>(
    text: &str,
    message: &str,
    parse: impl Fn(&str) -> Result<P, Error>,
) -> Option<usize> {
    let table = DeTable::parse(text).ok()?;
    let mut assignments = Vec::new();
    collect(table.get_ref(), &[], &mut assignments);
    let is_refused =
        |one: &&Assignment| parse(&one.toml(text)).is_err_and(|error| error.message() == message);
    let Assignment { keys, .. } = assignments.iter().find(is_refused)?;
    let is_unknown = |key: &&Range<usize>| {
        message.starts_with(&format!("unknown field `{}`", text.get((*key).clone()).unwrap_or_default()))
    };
    let key = keys.iter().find(is_unknown).or(keys.last())?;
    Some(1 + text.get(..key.start)?.matches('\n').count())
}

/// A value of a text with the keys that lead to it.
struct Assignment {
    keys: Vec<Range<usize>>,
    value: Range<usize>,
}

impl Assignment {
    /// This one alone.
    fn toml(&self, text: &str) -> String {
        let part = |range: &Range<usize>| text.get(range.clone()).unwrap_or_default();
        let keys: Vec<&str> = self.keys.iter().map(part).collect();
        format!("{} = {}", keys.join("."), part(&self.value))
    }
}

fn collect(table: &DeTable<'_>, path: &[Range<usize>], found: &mut Vec<Assignment>) {
    for (key, value) in table {
        let keys = [path, &[key.span()]].concat();
        match value.get_ref() {
            DeValue::Table(inner) => collect(inner, &keys, found),
            _ => found.push(Assignment { keys, value: value.span() }),
        }
    }
}

#[cfg(test)]
mod tests {
    use wayfix_system_core::settings::from_toml;
    use wayfix_systems::track::TrackParams;

    use super::*;

    #[test]
    fn line_is_that_of_the_unknown_key_or_the_wrong_value() {
        let line = |text| {
            let error = from_toml::<TrackParams>(text).err()?;
            refused_line(text, error.message(), from_toml::<TrackParams>)
        };
        assert_eq!(line("[contour]\nn_samples = 50\n"), None);
        assert_eq!(line("# ours\n[contour]\nn_samples = 50\nn_smaples = 50\n"), Some(4));
        assert_eq!(line("contour.n_samples = 50\ncontour = { n_samples = 'many' }"), None); // no TOML
        assert_eq!(line("\ncontour = { n_samples = 'many' }"), Some(2));
        assert_eq!(line("[contour]\nn_smaples = 5\nn_samples = 'many'"), Some(3)); // the error that is told
        assert_eq!(line("\n[edges]\n\nn_samples = 50"), Some(2));
    }
}
