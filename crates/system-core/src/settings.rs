//! Parameter files that override defaults.

use serde::{Serialize, de::DeserializeOwned};

/// The default parameters, overridden by the values of a TOML text.
///
/// # Errors
/// Returns an error if the text is not valid TOML, or contains an unknown key or a value of the wrong type. It names the line.
pub fn from_toml<T: Default + Serialize + DeserializeOwned>(text: &str) -> Result<T, toml::de::Error> {
    over_defaults(&T::default(), text)
}

/// Returns `defaults` overridden by the values of a TOML text.
///
/// # Errors
/// As for [`from_toml`].
pub fn over_defaults<T: Serialize + DeserializeOwned>(
    defaults: &T,
    text: &str,
) -> Result<T, toml::de::Error> {
    let mut values = toml::Table::try_from(defaults).map_err(serde::de::Error::custom)?;
    overlay(&mut values, toml::from_str(text)?);
    // Only the text itself knows the line of what is wrong in it.
    values.try_into().map_err(|error: toml::de::Error| match toml::from_str::<T>(text) {
        Err(placed) if placed.message() == error.message() => placed,
        _ => error,
    })
}

/// Writes the values of `upper` over those of `lower`, table by table.
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
