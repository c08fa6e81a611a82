//! Terminal output and progress of a command.

mod output;
mod progress;
mod stopwatch;

pub use output::{print, print_message};
pub use progress::{bar, counter};
pub use stopwatch::Stopwatch;
