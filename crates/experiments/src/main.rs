//! The program `wayfix-experiments`, which `cargo xtask regress` runs.

use std::process::ExitCode;

fn main() -> ExitCode {
    wayfix_experiments::cli::main()
}
