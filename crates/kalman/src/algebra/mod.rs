//! Factorizations and products that the filters share.

pub(crate) mod ldl;
pub(crate) mod product;
pub(crate) mod transport;
