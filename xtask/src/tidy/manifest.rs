//! A minimal parser of `Cargo.toml` for the checks.

/// A `key = value` line with its section.
pub(super) struct Entry<'a> {
    pub(super) section: &'a str,
    /// Up to the first dot, so that `rand.workspace = true` has the key `rand`.
    pub(super) key: &'a str,
    pub(super) value: &'a str,
    pub(super) line: usize,
}

/// All entries, in order; `[dependencies.rand]` counts as an entry `rand` of `dependencies`.
pub(super) fn entries(text: &str) -> Vec<Entry<'_>> {
    let mut section = "";
    let mut entries = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let line_number = index + 1;
        let line = line.trim();
        if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.split(']').next()) {
            section = name.trim_matches('[');
            if let Some((table, key)) = section.rsplit_once("dependencies.") {
                let table = &section[..table.len() + "dependencies".len()];
                entries.push(Entry { section: table, key, value: "", line: line_number });
            }
        } else if let Some((key, value)) = line.split_once('=').filter(|_| !line.starts_with('#')) {
            let key = key.trim().split('.').next().unwrap_or_default().trim_matches('"');
            entries.push(Entry { section, key, value: value.trim(), line: line_number });
        }
    }
    entries
}

/// The value of `key` in `section`, without quotes.
pub(super) fn value<'a>(text: &'a str, section: &str, key: &str) -> Option<&'a str> {
    let entry = entries(text).into_iter().find(|entry| entry.section == section && entry.key == key)?;
    let value = entry.value;
    Some(value.strip_prefix('"').and_then(|rest| rest.split('"').next()).unwrap_or(value))
}

/// The folder below `crates` (or `xtask`) of the manifest `path`.
pub(super) fn member(path: &str) -> Option<&str> {
    let folder = path.strip_suffix("/Cargo.toml")?;
    let name = folder.strip_prefix("crates/").unwrap_or(folder);
    (!name.contains('/') && (folder != name || name == "xtask")).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_know_their_section() {
        let text = "[package]\nname = \"a\" # why\n[dependencies]\nrand.workspace = true\n[dependencies.image]\nversion = \"1\"\n";
        assert_eq!(value(text, "package", "name"), Some("a"));
        let dependencies: Vec<_> =
            entries(text).iter().filter(|e| e.section == "dependencies").map(|e| (e.key, e.line)).collect();
        assert_eq!(dependencies, [("rand", 4), ("image", 5)]);
    }

    #[test]
    fn members_are_direct_children() {
        assert_eq!(member("crates/kalman/Cargo.toml"), Some("kalman"));
        assert_eq!(member("xtask/Cargo.toml"), Some("xtask"));
        assert_eq!(member("crates/kalman/peers/Cargo.toml"), None);
        assert_eq!(member("Cargo.toml"), None);
    }
}
