//! `cargo xtask licenses`: whether `deny.toml` allows the licence and the source of every dependency, and no version is `*`: the part of `cargo deny`
//! that needs no other program.

use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use serde_json::Value;

use crate::shell;

pub(crate) fn run(args: &[String]) -> Result<ExitCode> {
    ensure!(args.is_empty(), "usage: cargo xtask licenses");
    let allowed = allowed(&std::fs::read_to_string(shell::root().join("deny.toml"))?)?;
    let metadata = ["metadata", "--format-version", "1", "--all-features", "--locked"];
    let metadata: Value = serde_json::from_str(&shell::output(&mut shell::command("cargo", &metadata))?)?;
    let packages = metadata["packages"].as_array().context("cargo metadata lists no packages")?;
    let licenses = packages.iter().filter_map(|package| refused(package, &allowed));
    let refused: Vec<String> = licenses.chain(packages.iter().flat_map(unknown_source)).collect();
    if !refused.is_empty() {
        bail!("deny.toml does not allow\n{}", refused.join("\n"));
    }
    println!("licenses: {} packages, all allowed", packages.len());
    Ok(ExitCode::SUCCESS)
}

/// The licences that `deny.toml` allows.
fn allowed(deny: &str) -> Result<Vec<String>> {
    let deny: toml::Table = deny.parse()?;
    let list = deny.get("licenses").and_then(|licenses| licenses.get("allow")?.as_array());
    let list = list.context("deny.toml has no list `licenses.allow`")?;
    Ok(list.iter().filter_map(|name| name.as_str().map(str::to_owned)).collect())
}

/// The package and its licence, unless it is allowed.
fn refused(package: &Value, allowed: &[String]) -> Option<String> {
    let license = package["license"].as_str().unwrap_or_default();
    let is_fine = is_allowed(license, &|name| allowed.iter().any(|known| known == name));
    (!is_fine).then(|| format!("    {}: {license:?}", package["name"].as_str().unwrap_or_default()))
}

const CRATES_IO: &str = "registry+https://github.com/rust-lang/crates.io-index";

/// The package if it is not from crates.io, and the dependencies of one of ours that have any version.
fn unknown_source(package: &Value) -> Vec<String> {
    let name = package["name"].as_str().unwrap_or_default();
    match package["source"].as_str() {
        Some(CRATES_IO) => Vec::new(),
        Some(source) => vec![format!("    {name}: from {source}")],
        None => {
            let dependencies = package["dependencies"].as_array().into_iter().flatten();
            // A path in the workspace needs no version.
            let is_any = |dependency: &&Value| dependency["req"] == "*" && dependency["path"].is_null();
            let named = |dependency: &Value| format!("    {name}: any version of {}", dependency["name"]);
            dependencies.filter(is_any).map(named).collect()
        }
    }
}

/// Whether an SPDX expression can be met: `OR` (formerly `/`) binds weaker than `AND`.
fn is_allowed(expression: &str, allows: &dyn Fn(&str) -> bool) -> bool {
    let expression = expression.replace('/', " OR ");
    split(&expression, " OR ").iter().any(|choice| {
        split(choice, " AND ").iter().all(|term| {
            let term = term.trim();
            match term.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')) {
                Some(inner) => is_allowed(inner, allows),
                None => allows(term),
            }
        })
    })
}

/// The parts between separators that are outside of parentheses.
fn split<'a>(text: &'a str, separator: &str) -> Vec<&'a str> {
    let (mut parts, mut start) = (Vec::new(), 0);
    for (at, _) in text.match_indices(separator) {
        let before = &text[start..at];
        if before.matches('(').count() == before.matches(')').count() {
            parts.push(before);
            start = at + separator.len();
        }
    }
    parts.push(&text[start..]);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_choice_and_every_part_of_it_must_be_allowed() {
        let allows = |name: &str| ["MIT", "Unicode-3.0"].contains(&name);
        for fine in ["MIT", "GPL-3.0 OR MIT", "Apache-2.0/MIT", "(MIT OR GPL-3.0) AND Unicode-3.0"] {
            assert!(is_allowed(fine, &allows), "{fine}");
        }
        for refused in ["", "GPL-3.0", "MIT AND GPL-3.0", "(MIT OR BSL-1.0) AND GPL-3.0"] {
            assert!(!is_allowed(refused, &allows), "{refused}");
        }
    }

    #[test]
    fn a_package_without_a_licence_is_refused() {
        let allowed = allowed("[licenses]\nallow = [\"MIT\"]\n").unwrap();
        let package = |license: &str| serde_json::json!({"name": "a", "license": license});
        assert_eq!(refused(&package("MIT"), &allowed), None);
        assert_eq!(refused(&serde_json::json!({"name": "a"}), &allowed).as_deref(), Some("    a: \"\""));
    }

    #[test]
    fn a_repository_and_any_version_are_refused() {
        let package =
            serde_json::json!({"name": "a", "source": "git+https://example.org/a", "dependencies": []});
        assert_eq!(unknown_source(&package), ["    a: from git+https://example.org/a"]);
        let dependency =
            |req: &str, path: Option<&str>| serde_json::json!({"name": "b", "req": req, "path": path});
        let dependencies = [dependency("*", None), dependency("*", Some("b")), dependency("^1", None)];
        let ours = serde_json::json!({"name": "a", "source": null, "dependencies": dependencies});
        assert_eq!(unknown_source(&ours), ["    a: any version of \"b\""]);
    }
}
