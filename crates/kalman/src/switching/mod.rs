//! Several models, one of which is active at a time.

mod bank;
mod gpb2;
mod hypotheses;
mod imm;
mod jump_markov;
mod markov_chain;

pub use bank::{FilterBank, FilterBankUpdate};
pub use gpb2::Gpb2Filter;
pub use imm::ImmFilter;
pub use jump_markov::{JumpMarkovFilter, JumpMarkovFilterParams};
pub use markov_chain::MarkovChain;
