//! What a command prints, and how far it has come.

mod output;
mod progress;

pub use output::{print, print_message};
pub use progress::{bar, counter};
