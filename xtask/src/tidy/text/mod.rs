//! Texts: words, pages, links, figures, what is left over.

pub(super) mod figures;
pub(super) mod leftovers;
pub(super) mod links;
pub(super) mod pages;
pub(super) mod words;
