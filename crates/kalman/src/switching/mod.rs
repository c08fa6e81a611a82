//! Several models, one of which is active at a time.

mod bank;
mod gpb2;
mod hypotheses;
mod imm;
mod jump_markov;
mod markov_chain;

pub use bank::{Candidate, ModelBank};
pub use gpb2::Gpb2;
pub use imm::Imm;
pub use jump_markov::{JumpMarkov, JumpMarkovParams};
pub use markov_chain::MarkovChain;
