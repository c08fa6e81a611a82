//! Parameters as TOML text with a comment for every key.

use schemars::transform::{RecursiveTransform, Transform as _};
use schemars::{JsonSchema, Schema, schema_for};
use serde::Serialize;
use serde_json::{Map, Value};
use toml_edit::{DocumentMut, Item, Table};

/// The JSON schema of parameters: editors complete and check TOML files by it.
pub(crate) fn schema_of<P: JsonSchema>() -> Schema {
    let mut schema = schema_for!(P);
    RecursiveTransform(without_examples).transform(&mut schema);
    schema
}

/// Leaves the Rust examples out of a description.
fn without_examples(schema: &mut Schema) {
    if let Some(Value::String(description)) = schema.get_mut("description") {
        let prose: String = description.split("```").step_by(2).collect();
        prose.trim().clone_into(description);
    }
}

/// `params` as TOML, with the documentation of every key above it; keys that are not set follow their table as comments
/// that show their syntax.
///
/// # Errors
/// Returns an error if the parameters have no TOML form.
pub(crate) fn commented<P: JsonSchema + Serialize>(params: &P) -> anyhow::Result<String> {
    let mut document: DocumentMut = toml::to_string(params)?.parse()?;
    let root = schema_of::<P>().to_value();
    comment_table(document.as_table_mut(), &root, &root);
    let text = document.to_string();
    Ok(text.trim_start().to_owned())
}

fn comment_table(table: &mut Table, schema: &Value, root: &Value) {
    let target = resolved(schema, root);
    let chosen = |variant: &&Map<String, Value>| variant.keys().any(|name| table.contains_key(name));
    let variants = target["oneOf"].as_array().into_iter().flatten();
    let variant = variants.filter_map(|variant| variant["properties"].as_object()).find(chosen);
    let Some(properties) = target["properties"].as_object().or(variant) else { return };
    let mut unset = String::new();
    for (key, property) in properties {
        let says = comment(property, root);
        if let Some(Item::Table(inner)) = table.get_mut(key) {
            inner.decor_mut().set_prefix(format!("\n{says}"));
            comment_table(inner, property, root);
        } else if let Some(Item::ArrayOfTables(inner)) = table.get_mut(key) {
            // A comment common to all entries appears once.
            if let Some(first) = inner.get_mut(0) {
                first.decor_mut().set_prefix(format!("\n{says}"));
                comment_table(first, &resolved(property, root)["items"], root);
            }
        } else if let Some(mut key) = table.key_mut(key) {
            key.leaf_decor_mut().set_prefix(says);
        } else {
            unset += &format!("{says}# {key} = {} # not set\n", syntax(property, root));
        }
    }
    // Behind the last key that has a value, still in front of the first table.
    let last = table.iter().filter(|(_, item)| item.is_value()).map(|(key, _)| key.to_owned()).last();
    let value = last.and_then(|last| table.get_mut(&last)).and_then(Item::as_value_mut);
    match (unset.is_empty(), value) {
        (true, _) => {}
        (false, Some(value)) => value.decor_mut().set_suffix(format!("\n{}", unset.trim_end())),
        (false, None) => {
            let before =
                table.decor().prefix().and_then(|prefix| prefix.as_str()).unwrap_or_default().to_owned();
            table.decor_mut().set_prefix(format!("{before}{unset}"));
        }
    }
}

/// The doc comment and the allowed values, as comment lines.
fn comment(property: &Value, root: &Value) -> String {
    let own = property["description"].as_str();
    let described = own.or_else(|| resolved(property, root)["description"].as_str()).unwrap_or_default();
    let mut lines: Vec<String> = paragraphs(&plain(described));
    for choice in choices(property, root) {
        lines.extend(choice);
    }
    lines.iter().map(|line| format!("# {line}\n")).collect()
}

/// The variants of an enumeration with their descriptions.
fn choices(property: &Value, root: &Value) -> Vec<Vec<String>> {
    let target = resolved(property, root);
    let variants = target["oneOf"].as_array().map(Vec::as_slice).unwrap_or_default();
    let variant = |variant: &Value| {
        let name = match (variant["const"].as_str(), variant["properties"].as_object()) {
            (Some(name), _) => format!("\"{name}\""),
            (None, Some(fields)) => format!("{{ {} = … }}", fields.keys().next()?),
            (None, None) => return None,
        };
        let means = plain(variant["description"].as_str().unwrap_or_default());
        Some(paragraphs(&format!("{name}: {means}")).into_iter().map(|line| format!("  {line}")).collect())
    };
    variants.iter().filter_map(variant).collect()
}

/// A value of the right syntax: defaults where there are any, else zeros and the first variant of an enumeration.
fn syntax(property: &Value, root: &Value) -> String {
    let target = resolved(property, root);
    let has_type = |name: &str| {
        target["type"] == name || target["type"].as_array().is_some_and(|all| all.contains(&name.into()))
    };
    let default = &property["default"];
    if default.is_number() || default.is_string() || default.is_boolean() {
        return default.to_string();
    }
    if let Some(variant) = target["oneOf"][0]["const"].as_str() {
        return format!("\"{variant}\"");
    }
    if let Some(fields) = target["properties"].as_object() {
        let fields: Vec<_> =
            fields.iter().map(|(key, field)| format!("{key} = {}", syntax(field, root))).collect();
        return format!("{{ {} }}", fields.join(", "));
    }
    if has_type("array") {
        let n = target["minItems"].as_u64().unwrap_or(1) as usize;
        return format!("[{}]", vec![syntax(&target["items"], root); n].join(", "));
    }
    let zeros = [("number", "0.0"), ("integer", "0"), ("boolean", "false")];
    zeros.into_iter().find(|(name, _)| has_type(name)).map_or("\"\"", |(_, zero)| zero).to_owned()
}

/// Resolves a reference to a definition, and an optional type to its inner type.
fn resolved<'a>(schema: &'a Value, root: &'a Value) -> &'a Value {
    let alternatives = schema["anyOf"].as_array().map(Vec::as_slice).unwrap_or_default();
    let schema = alternatives.iter().find(|one| one["type"] != "null").unwrap_or(schema);
    let definition = schema["$ref"].as_str().and_then(|path| path.strip_prefix('#'));
    definition.and_then(|pointer| root.pointer(pointer)).unwrap_or(schema)
}

/// Text without the marks of formulas, code and links.
fn plain(markdown: &str) -> String {
    let mut text = String::new();
    let mut rest = markdown;
    while let Some((before, after)) = rest.split_once("`](") {
        text += before;
        rest = after.split_once(')').map_or("", |(_, rest)| rest);
    }
    text += rest;
    let code = text.replace("$`", "").replace("`$", "").replace("[`", "").replace("`]", "");
    code.replace('`', "").replace("\\,", " ")
}

/// Lines of at most some 100 characters; an empty one between paragraphs is left out.
fn paragraphs(text: &str) -> Vec<String> {
    let mut lines = Vec::new();
    for paragraph in text.split("\n\n").filter(|paragraph| !paragraph.trim().is_empty()) {
        let mut line = String::new();
        for word in paragraph.split_whitespace() {
            if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > WIDTH {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line += word;
        }
        lines.push(line);
    }
    lines
}

const WIDTH: usize = 100;

#[cfg(test)]
mod tests {
    use super::*;
    use wayfix_slam_system::{
        points::{PointSlamParams, RobotProfile},
        walls::WallSlamParams,
    };
    use wayfix_systems::{cml::CmlParams, color::ColorSystemParams, track::TrackParams, views::ViewsParams};

    fn same_with_comments<P: JsonSchema + Serialize + PartialEq + serde::de::DeserializeOwned>(params: &P) {
        let text = commented(params).unwrap();
        assert!(toml::from_str::<P>(&text).unwrap() == *params, "{text}");
        // The selected variant has its own table, below the description of the enumeration; only the first of many tables has comments.
        let (mut table, mut above, mut bare) = ("", "", Vec::new());
        for line in text.lines() {
            if line.starts_with('[') {
                table = line;
            }
            let is_key = line.contains(" = ") && !line.starts_with('#');
            if is_key && !above.starts_with(['#', '[']) && !table.starts_with("[[") {
                bare.push(line);
            }
            above = line;
        }
        assert!(bare.is_empty(), "keys without a word: {bare:?}");
    }

    #[test]
    fn comments_change_nothing_and_every_key_has_one() {
        same_with_comments(&PointSlamParams::of(RobotProfile::Utias));
        same_with_comments(&WallSlamParams::default());
        same_with_comments(&ColorSystemParams::default());
        same_with_comments(&ViewsParams::default());
        same_with_comments(&TrackParams::default());
        same_with_comments(&CmlParams::default());
        same_with_comments(&wayfix_line_extract::LineExtractionParams::default());
    }

    #[test]
    fn keys_that_are_not_set_show_a_syntax_that_is_read() {
        fn uncommented<P: JsonSchema + Serialize + serde::de::DeserializeOwned>(params: &P) -> usize {
            let text = commented(params).unwrap();
            let shown = text.lines().filter(|line| line.ends_with("# not set"));
            for line in shown.clone() {
                let with = text.replacen(line, line.trim_start_matches("# "), 1);
                assert!(toml::from_str::<P>(&with).is_ok(), "{line}: {:?}", toml::from_str::<P>(&with).err());
            }
            shown.count()
        }
        assert!(uncommented(&PointSlamParams::of(RobotProfile::Generic)) > 5);
        assert!(uncommented(&WallSlamParams::default()) > 5);
        assert!(uncommented(&ColorSystemParams::default()) > 3);
        assert!(uncommented(&TrackParams::default()) > 0);
        assert!(uncommented(&CmlParams::default()) > 0);
    }

    #[test]
    fn units_choices_and_what_is_not_set_are_told() {
        let text = commented(&PointSlamParams::of(RobotProfile::Generic)).unwrap();
        for part in [
            "# Time from the exposure of the sensor to the stamp of what it saw, s.",
            "\"downweight\": Their weight decreases",
            "# start_pose = [0.0, 0.0, 0.0] # not set",
            "# association = \"known\" # not set",
            "# datum = [0.0, 0.0] # not set",
            "# merging = { min_separation = 0.1, n_sigmas = 2.0 } # not set",
        ] {
            assert!(text.contains(part), "{part} in\n{text}");
        }
        assert!(!text.contains("](") && !text.contains('$'), "{text}");
        assert_eq!(plain("a [`B`](crate::B) of $`x^2`$, [Schulz 2004]"), "a B of x^2, [Schulz 2004]");
    }
}
