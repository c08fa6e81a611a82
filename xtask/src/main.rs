//! The workspace's tasks, one file each; every task shells out to the tools that do the work.

mod bench;
mod campaign;
mod ci;
mod clients;
mod docs;
mod examples;
mod fixtures;
mod licenses;
mod regress;
mod robot;
mod shell;
mod spelling;
mod tidy;
mod tutorials;

use std::process::ExitCode;

const HELP: &str = "\
Usage: cargo xtask TASK [OPTIONS]

  regress [SUITE|RUN…]   run the systems on stored logs, compare figures with bounds, write the report after every run
                     [--data DIR] [--out DIR] [--seed N] [--quick] [--all] [--resume] [--bless] [--threads N]
                     a suite, a run or --all runs the experiments too
                     DIR of --data defaults to $WAYFIX_DATA, of --out to target/regress
  fixtures           rebuild every stored log from its seed; --check compares and writes nothing
  ci                 what CI runs, cheap steps first; --from STEP resumes
  tidy               check the invariants of docs/architecture.md that a machine can check; --write redraws its picture
  spelling           look for misspelled words
  licenses           check the licences of all dependencies against deny.toml
  docs [PACKAGE…]    build one site of the API reference and docs/, with formulas, and follow its links; --open shows it;
                     --figures [REPORT] writes the tables of measured figures in docs/ from a report of regress;
                     --transcripts runs the commands of the recordings in docs/ and writes what they print;
                     --papers [REPORT] writes docs/papers.md anew, with the measured figures of a report
  examples [NAME…]   run the examples that take no arguments
  tutorials [NAME…]  type what docs/tutorials tells a reader to type
  bench [FILTER]     run the benchmarks, print one table; --peers adds other programs, --data DIR finds their logs
  campaign           run the recipe for GNU parallel of docs/campaigns
  robot              build and run the robots of the folder robots, which are outside the workspace
  clients [DIR]      read the report and the logs in DIR (default target/regress) with other people's programs
";

fn main() -> ExitCode {
    let mut args = std::env::args().skip(1);
    let task = args.next().unwrap_or_default();
    let args: Vec<String> = args.collect();
    if args.iter().any(|arg| arg == "--help" || arg == "-h") && task != "regress" {
        print!("{HELP}");
        return ExitCode::SUCCESS;
    }
    let outcome = match task.as_str() {
        "regress" => regress::run(&args),
        "fixtures" => fixtures::run(&args),
        "ci" => ci::run(&args),
        "tidy" => tidy::run(&args),
        "docs" => docs::run(&args),
        "bench" => bench::run(&args),
        "clients" => clients::run(&args),
        "campaign" => campaign::run(&args),
        "robot" => robot::run(&args),
        "licenses" => licenses::run(&args),
        "spelling" => spelling::run(&args),
        "examples" => examples::run(&args),
        "tutorials" => tutorials::run(&args),
        "" | "help" | "--help" | "-h" => {
            print!("{HELP}");
            Ok(ExitCode::SUCCESS)
        }
        other => Err(anyhow::anyhow!("there is no task `{other}`\n\n{HELP}")),
    };
    outcome.unwrap_or_else(|error| {
        eprintln!("xtask {task}: {error:#}");
        ExitCode::FAILURE
    })
}
