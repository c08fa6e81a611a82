//! `cargo xtask tutorials`: runs the commands of the tutorials in `docs/tutorials`.

use std::fs;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};

use crate::shell;

pub(crate) fn run(args: &[String]) -> Result<ExitCode> {
    shell::check(&mut shell::build("wayfix"))?;
    let mut n_run = 0;
    for entry in fs::read_dir(shell::root().join("docs/tutorials"))? {
        let page = entry?.path();
        let name = page.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if args.is_empty() || args.contains(&name) {
            follow(&page, &name).with_context(|| format!("docs/tutorials/{name}.md"))?;
            n_run += 1;
        }
    }
    if n_run == 0 {
        bail!("usage: cargo xtask tutorials [NAME…], a name being that of a file in docs/tutorials");
    }
    println!("tutorials: {n_run} followed");
    Ok(ExitCode::SUCCESS)
}

/// Runs every command of a page in a folder with the layout of the repository's root.
fn follow(page: &Path, name: &str) -> Result<()> {
    let folder = shell::target_dir().join("tutorials").join(name);
    if folder.exists() {
        fs::remove_dir_all(&folder)?;
    }
    fs::create_dir_all(&folder)?;
    let root = shell::root();
    let mut link = shell::command("ln", &["-s"]);
    shell::check(link.arg(root.join("fixtures")).arg(root.join("params")).arg(&folder))?;

    let programs = shell::target_dir().join("debug").into_os_string();
    let path = std::env::join_paths(
        std::iter::once(programs.into())
            .chain(std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default())),
    )?;
    for script in scripts(&fs::read_to_string(page)?) {
        println!("{name}: {}", script.trim_end().replace('\n', "\n    "));
        let mut shell = shell::command("sh", &["-eu", "-c", &script]);
        shell::check(shell.current_dir(&folder).env("PATH", &path))?;
    }
    Ok(())
}

/// The blocks of a page that are marked `sh`.
fn scripts(text: &str) -> Vec<String> {
    let (mut scripts, mut inside) = (Vec::new(), false);
    for line in text.lines() {
        match (line.trim_end(), inside) {
            ("```sh", false) => {
                scripts.push(String::new());
                inside = true;
            }
            ("```", true) => inside = false,
            (command, true) => {
                if let Some(script) = scripts.last_mut() {
                    *script += command;
                    script.push('\n');
                }
            }
            _ => {}
        }
    }
    scripts
}

#[cfg(test)]
mod tests {
    use super::scripts;

    #[test]
    fn only_blocks_of_the_shell_are_typed() {
        let page = "a\n```sh\nls\npwd\n```\n```rust\nlet x = 1;\n```\n```sh\ntrue\n```\n";
        assert_eq!(scripts(page), ["ls\npwd\n", "true\n"]);
    }
}
