//! The linear problem of a step: sparse normal equations and their Cholesky factor.

pub(crate) mod block_address;
pub(crate) mod cholesky;
pub(crate) mod normal_equations;
pub(crate) mod pattern;
