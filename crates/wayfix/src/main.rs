//! The command `wayfix`.

use std::process::ExitCode;

fn main() -> ExitCode {
    wayfix::cli::main()
}
