//! Checks of texts: words, pages, links, figures, leftovers.

pub(super) mod figures;
pub(super) mod leftovers;
pub(super) mod links;
pub(super) mod pages;
pub(super) mod words;
