//! Files of parameters that name only what they change.

use serde::{Serialize, de::DeserializeOwned};

/// `defaults`, with the values that a TOML text names in their place.
///
/// # Errors
/// When the text is no TOML, or names a key that does not exist or a value of another kind.
pub(crate) fn over_defaults<T: Serialize + DeserializeOwned>(
    defaults: &T,
    text: &str,
) -> Result<T, toml::de::Error> {
    let mut values = toml::Table::try_from(defaults).map_err(serde::de::Error::custom)?;
    overlay(&mut values, toml::from_str(text)?);
    values.try_into()
}

/// Puts the values of `upper` over those of `lower`, table by table.
fn overlay(lower: &mut toml::Table, upper: toml::Table) {
    for (key, value) in upper {
        match (lower.get_mut(&key), value) {
            (Some(toml::Value::Table(lower)), toml::Value::Table(upper)) => overlay(lower, upper),
            (_, value) => {
                lower.insert(key, value);
            }
        }
    }
}
