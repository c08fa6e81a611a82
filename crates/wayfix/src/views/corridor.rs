//! Places along a corridor that was driven twice.
