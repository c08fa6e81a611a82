//! Parameters of a run from a file.

mod renamed;

use std::path::Path;

use anyhow::{Context, Result};
use wayfix_sensor_log::read_text;

use renamed::{present_name, replacement};

/// Parameters of a system from a TOML file.
///
/// The error names the file, the template of the system, the line and the key.
pub(super) fn read_toml<P>(
    path: &Path,
    system: &str,
    parse: impl Fn(&str) -> Result<P, toml::de::Error>,
) -> Result<P> {
    let text = read_text(path).with_context(|| format!("cannot read parameters from {}", path.display()))?;
    let read = parse(&text).map_err(|error| {
        anyhow::anyhow!("{}{}", error.to_string().trim_end(), hint(error.message()).unwrap_or_default())
    });
    let path = path.display();
    read.with_context(|| {
        format!("parameters in {path} are not usable (`wayfix params {system}` lists those of this run)")
    })
}

/// The present name of an unknown key, or the most similar name, from a message "unknown field `a`, expected one of `b`, `c`".
fn hint(message: &str) -> Option<String> {
    let names = message.strip_prefix("unknown ").map(|rest| rest.split('`').skip(1).step_by(2))?;
    let mut names = names.map(|name| name.trim());
    let unknown = names.next()?;
    let allowed: Vec<&str> = names.collect();
    if let Some(name) = present_name(unknown, allowed.iter().copied()) {
        return Some(format!("\n`{unknown}` is called `{name}` now"));
    }
    if let Some(what) = replacement(unknown, allowed.iter().copied()) {
        return Some(format!("\n`{unknown}` was replaced: {what}"));
    }
    let likeness = |name: &str| strsim::jaro_winkler(unknown, name);
    let alike = allowed.into_iter().filter(|name| likeness(name) > ALIKE);
    alike.max_by(|a, b| likeness(a).total_cmp(&likeness(b))).map(|name| format!("\ndid you mean `{name}`?"))
}

/// Minimum similarity of a mistyped word: one or two letters wrong, swapped or missing.
const ALIKE: f64 = 0.8;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_is_recognized_and_nonsense_is_not() {
        let message =
            "unknown field `gate_probabilty`, expected one of `outliers`, `gate_probability`, `order`";
        assert_eq!(hint(message).as_deref(), Some("\ndid you mean `gate_probability`?"));
        assert_eq!(hint("unknown field `zzz`, expected one of `outliers`, `order`"), None);
        let variant = hint("unknown variant `jcb`, expected one of `known`, `nn`, `jcbb`");
        assert_eq!(variant.as_deref(), Some("\ndid you mean `jcbb`?"));
        let old = hint("unknown field `looks`, expected one of `keyframes`, `lines`");
        assert_eq!(old.as_deref(), Some("\n`looks` is called `keyframes` now"));
        assert_eq!(hint("invalid type: string \"x\", expected f64"), None);
    }
}
