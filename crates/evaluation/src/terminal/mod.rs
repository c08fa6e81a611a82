//! Terminal output and progress of a command.

mod output;
mod progress;

pub use output::{print, print_message};
pub use progress::{bar, counter};
