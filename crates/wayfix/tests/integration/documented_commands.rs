//! Every command line that README, docs and help texts tell a reader to type is one that the program takes.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::{
    fs,
    path::{Path, PathBuf},
};

use clap::Command;
use wayfix::cli;

use crate::common::{Scratch, wayfix as call};

/// Where a command line stands, and itself.
struct Line {
    source: String,
    text: String,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn markdown(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            markdown(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "md") {
            found.push(path);
        }
    }
    found.sort();
}

/// The commands in a line of a block; columns stand at least two blanks apart, and what is no command is a remark.
fn columns(line: &str) -> Vec<String> {
    let line = line.split(" #").next().unwrap_or_default();
    let mut parts: Vec<String> = Vec::new();
    for part in line.split("  ").map(str::trim).filter(|part| !part.is_empty()) {
        // an option belongs to the command before the gap, which is there to align several lines
        match parts.last_mut().filter(|_| part.starts_with('-') || part.starts_with('|')) {
            Some(last) => *last += &format!(" {part}"),
            None => parts.push(part.to_owned()),
        }
    }
    parts
}

/// What of a text is a command line: from the name of the program to a redirection or the next command.
fn command_in(text: &str) -> Option<String> {
    let starts = ["wayfix ", "wayfix-experiments ", "cargo run ", "cargo xtask "];
    let text = text.trim_start_matches("$ ").trim_start_matches("then: ");
    let text = text.split(" > ").next()?.split(" && ").next()?.trim();
    if let Some(system) = text.strip_prefix("run ") {
        let systems = ["slam ", "lines ", "color ", "views ", "track ", "cml "];
        return systems.iter().any(|name| system.starts_with(name)).then(|| format!("wayfix {text}"));
    }
    let rest = starts.iter().find_map(|start| text.strip_prefix(start))?;
    // neither prose nor an arrow in a diagram
    rest.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '-').then(|| text.to_owned())
}

fn in_block(source: &str, block: &str) -> Vec<Line> {
    let joined = block.replace("\\\n", " ");
    let commands = joined.lines().flat_map(columns).filter_map(|column| command_in(&column));
    commands.map(|text| Line { source: source.to_owned(), text }).collect()
}

fn in_markdown(path: &Path) -> Vec<Line> {
    let source = path.display().to_string();
    let text = fs::read_to_string(path).unwrap();
    let mut lines = Vec::new();
    for (k, part) in text.split("```").enumerate() {
        if k % 2 == 1 {
            lines.extend(in_block(&source, part));
            continue;
        }
        let spans = part.split('`').skip(1).step_by(2).map(|span| span.replace('\n', " "));
        let commands = spans.filter_map(|span| command_in(&span));
        lines.extend(commands.map(|text| Line { source: source.clone(), text }));
    }
    lines
}

fn in_help(command: &Command, path: &str, lines: &mut Vec<Line>) {
    let path = format!("{path} {}", command.get_name());
    let texts = [command.get_long_about(), command.get_after_long_help(), command.get_after_help()];
    for text in texts.into_iter().flatten() {
        lines.extend(in_block(&format!("{path} --help"), &text.to_string()));
    }
    command.get_subcommands().for_each(|child| in_help(child, &path, lines));
}

fn documented() -> Vec<Line> {
    let mut files = vec![root().join("README.md")];
    markdown(&root().join("docs"), &mut files);
    let mut lines: Vec<Line> = files.iter().flat_map(|path| in_markdown(path)).collect();
    in_help(&cli::commands(), "", &mut lines);
    lines
}

/// What a reader puts in the place of a placeholder.
fn filled_in(word: &str) -> String {
    match word.trim_matches(['\'', '"']) {
        "x,y,w,h" | "BOX" => "1,2,3,4".to_owned(),
        "X,Y,HEADING" => "1,2,90".to_owned(),
        "N" => "1".to_owned(),
        "SYSTEM" => "slam".to_owned(),
        "NAME" => "beetle".to_owned(),
        "SHELL" => "bash".to_owned(),
        other => other.replace('…', "x"),
    }
}

/// The words of a synopsis that are not optional, the first alternative of each, and all of its options.
fn synopsis(words: &[String]) -> (Vec<String>, Vec<String>) {
    let text = words.join(" ");
    let is_option = |word: &&str| word.starts_with("--");
    let plain = text.replace(['[', ']', '(', ')', '|'], " ");
    let options = plain.split_whitespace().filter(is_option).map(str::to_owned).collect();
    let (mut depth, mut needed) = (0, String::new());
    for c in text.chars() {
        depth += i32::from(c == '[');
        if depth == 0 {
            needed.push(c);
        }
        depth -= i32::from(c == ']');
    }
    (first_alternatives(&needed.replace('…', " ")), options)
}

/// The words without second alternatives: of "a|b" the first; after " | " an option and its value, or what is in parentheses, is left out.
fn first_alternatives(text: &str) -> Vec<String> {
    let mut kept = Vec::new();
    let mut words = text.split_whitespace().peekable();
    while let Some(word) = words.next() {
        if word != "|" {
            kept.push(word.split('|').next().unwrap_or_default().trim_matches(['(', ')']).to_owned());
        } else if words.peek().is_some_and(|word| word.starts_with('(')) {
            words.by_ref().find(|word| word.ends_with(')'));
        } else {
            words.next();
            words.next_if(|word| !word.starts_with('-') && *word != "|");
        }
    }
    kept
}

/// The command that the first words name, and how many words that took.
fn named<'a>(words: &[String], commands: &'a Command) -> (&'a Command, usize) {
    let mut command = commands;
    for (k, word) in words.iter().enumerate() {
        match command.find_subcommand(word) {
            Some(child) => command = child,
            None => return (command, k),
        }
    }
    (command, words.len())
}

fn check_wayfix(words: &[String], commands: &Command) -> Result<(), String> {
    check_words(words, commands, cli::parses::<String>)
}

/// Whether a program that has these commands and parses lines like this takes these words.
fn check_words(
    words: &[String],
    commands: &Command,
    parses: impl Fn(Vec<String>) -> Result<(), clap::Error>,
) -> Result<(), String> {
    let is_synopsis = words.iter().any(|word| word.contains(['[', '|']));
    let (needed, options) = if is_synopsis { synopsis(words) } else { (words.to_vec(), Vec::new()) };
    let (command, n_named) = named(&needed, commands);
    if n_named == 0 && words == ["--help"] {
        return Ok(());
    }
    if n_named == 0 {
        return Err("no such command".to_owned());
    }
    for option in options {
        let name = option.trim_start_matches('-');
        if name != "live"
            && name != "pace"
            && !command.get_arguments().any(|arg| arg.get_long() == Some(name))
        {
            return Err(format!("no option {option}"));
        }
    }
    if needed.len() == n_named {
        // a command that is spoken of, not one to type
        return Ok(());
    }
    let is_without = |word: &&String| cfg!(feature = "live") || *word != "--live";
    let filled = needed.iter().filter(is_without).map(|word| filled_in(word));
    parses(std::iter::once(String::new()).chain(filled).collect())
        .map_err(|error| error.to_string().lines().next().unwrap_or_default().to_owned())
}

fn check_experiments(words: &[String]) -> Result<(), String> {
    use wayfix_experiments::cli;
    check_words(words, &cli::commands(), cli::parses::<String>)
}

fn check_xtask(words: &[String]) -> Result<(), String> {
    let Some((task, rest)) = words.split_first() else { return Err("no task".to_owned()) };
    let tasks = fs::read_to_string(root().join("xtask/src/main.rs")).unwrap();
    if !tasks.contains(&format!("\"{task}\" =>")) {
        return Err(format!("no task {task}"));
    }
    // what follows is handed on to the program
    if task == "regress" && !rest.is_empty() { check_experiments(words) } else { Ok(()) }
}

fn check_cargo_run(words: &[String], commands: &Command) -> Result<(), String> {
    let value_of = |names: &[&str]| {
        let place = words.iter().position(|word| names.contains(&word.as_str()))?;
        words.get(place + 1).map(String::as_str)
    };
    let package = value_of(&["-p", "--package"]).unwrap_or("wayfix");
    if let Some(example) = value_of(&["--example"]) {
        let folder = package.strip_prefix("wayfix-").unwrap_or(package);
        let path = root().join("crates").join(folder).join("examples").join(format!("{example}.rs"));
        return if path.exists() { Ok(()) } else { Err(format!("no example {example}")) };
    }
    let Some(place) = words.iter().position(|word| word == "--") else { return Ok(()) };
    if package != "wayfix" || place + 1 == words.len() {
        return Ok(());
    }
    check_wayfix(&words[place + 1..], commands)
}

fn check(line: &Line, commands: &Command) -> Result<(), String> {
    let words: Vec<String> = line.text.split_whitespace().map(str::to_owned).collect();
    match words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["wayfix", ..] => check_wayfix(&words[1..], commands),
        ["cargo", "xtask", ..] => check_xtask(&words[2..]),
        ["wayfix-experiments", ..] => check_experiments(&words[1..]),
        ["cargo", "run", ..] => check_cargo_run(&words[2..], commands),
        _ => Err("not a command".to_owned()),
    }
}

#[test]
fn every_documented_command_line_is_understood() {
    let (commands, lines) = (cli::commands(), documented());
    let wrong: Vec<String> = lines
        .iter()
        .filter_map(|line| Some(format!("{}: {}: {}", line.source, line.text, check(line, &commands).err()?)))
        .collect();
    assert!(wrong.is_empty(), "{} of {} lines:\n{}", wrong.len(), lines.len(), wrong.join("\n"));
    // the places that are searched are the ones that hold commands
    for source in ["README.md", "tutorials/slam.md", "architecture.md", "run color --help", "wayfix --help"] {
        assert!(lines.iter().any(|line| line.source.ends_with(source)), "nothing found in {source}");
    }
}

#[test]
fn a_command_line_that_does_not_exist_is_noticed() {
    let commands = cli::commands();
    for text in [
        "wayfix run color --log my.mcap",
        "wayfix run slam --log my.mcap --no-such-option",
        "wayfix run track --frames DIR [--no-such-option]",
        "wayfix no-such-command",
        "cargo run -p wayfix -- run lines",
        "cargo run -p wayfix -- run lines --log",
        "cargo run -p wayfix-kalman --example no_such_example",
        "cargo xtask no-such-task",
    ] {
        let line = Line { source: String::new(), text: text.to_owned() };
        let expected = text != "cargo run -p wayfix -- run lines"; // spoken of
        assert_eq!(check(&line, &commands).is_err(), expected, "{text}");
    }
}

#[test]
fn commands_are_found_among_remarks_columns_and_prose() {
    let texts = |lines: Vec<Line>| lines.into_iter().map(|line| line.text).collect::<Vec<_>>();
    let block =
        "wayfix info a.mcap     wayfix convert A B  # a remark\n  wayfix run slam  --log a > b   a remark\n";
    let found = texts(in_block("", block));
    assert_eq!(found, ["wayfix info a.mcap", "wayfix convert A B", "wayfix run slam --log a"]);
}

#[test]
fn priors_are_written_without_a_log_or_a_map() {
    let scratch = Scratch::new();
    let path = scratch.path("priors.json");
    let file = path.to_str().unwrap();
    for more in [&[][..], &["--log", "my.mcap", "--map", "my-field.toml"][..]] {
        let outcome = call([&["run", "color", "--write-priors", file], more].concat());
        assert_eq!(outcome.code, 0, "{}", outcome.stderr);
        assert!(!fs::read_to_string(&path).unwrap().is_empty());
        fs::remove_file(&path).unwrap();
    }
    let outcome = call(["run", "color"]);
    assert!(
        outcome.code == 2 && outcome.stderr.contains("--log") && outcome.stderr.contains("--map"),
        "{outcome:?}"
    );
}

#[test]
fn every_system_prints_its_parameters_without_input() {
    for system in ["slam", "lines", "color", "views", "track", "cml"] {
        let printed = call(["run", system, "--print-params"]);
        assert_eq!((printed.code, &*printed.stderr), (0, ""), "{system}");
        assert_eq!(printed.stdout, call(["params", system]).stdout, "{system}");
    }
}
