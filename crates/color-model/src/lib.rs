//! Colours under unknown light: adaptive colour models, and localization in coloured maps.
