use plotters::style::{Color, RGBAColor, RGBColor};

use super::named;

/// Custom properties of a light page.
pub(crate) const LIGHT_PALETTE: &str = "--paper:#fdfdfb;--text:#1c1e21;--muted:#62676e;--grid:#e4e5e2;\
    --ink-0:#1765ad;--ink-1:#c2600b;--ink-2:#1b7f4d;--ink-3:#a3297a;--ink-4:#7a5c00;--ink-5:#5b4bc4";
/// Custom properties of a dark page: the same hues, each at least 4.5 : 1 against the paper.
pub(crate) const DARK_PALETTE: &str = "--paper:#15171a;--text:#e3e5e8;--muted:#9aa0a8;--grid:#2b2f34;\
    --ink-0:#6fb1f0;--ink-1:#f0a050;--ink-2:#63cb95;--ink-3:#ea86c6;--ink-4:#d9b84a;--ink-5:#a79bf5";

/// Number of colours for data.
const N_DATA_INKS: u8 = 6;

/// Ink of a mark; the page defines its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plot) enum Ink {
    Text,
    Muted,
    Grid,
    /// One of the data colours, counted round.
    Data(u8),
    /// The same, dashed.
    Dashed(u8),
    /// One of the colours that have a name.
    Named(u8),
}

impl Ink {
    pub(in crate::plot) const TRUTH: Self = Self::Muted;
    pub(in crate::plot) const ESTIMATE: Self = Self::Data(0);
    pub(in crate::plot) const DEAD_RECKONING: Self = Self::Dashed(1);
    pub(in crate::plot) const LANDMARK: Self = Self::Data(3);
    pub(in crate::plot) const ECHO: Self = Self::Data(2);

    /// The colour of series number `index`.
    pub(in crate::plot) fn of_series(index: usize) -> Self {
        Self::Data((index % usize::from(N_DATA_INKS)) as u8)
    }

    /// The colour called `name`, or the colour of series number `index`.
    pub(in crate::plot) fn of_name(name: &str, index: usize) -> Self {
        named::index_of(name).map_or_else(|| Self::of_series(index), Self::Named)
    }

    /// A placeholder colour for this ink in the output of the SVG backend; [`Ink::replace_markers`] removes it.
    pub(in crate::plot) fn marker(self, opacity: f64) -> RGBAColor {
        RGBColor(0xF0, 0x0D, self.code()).mix(opacity)
    }

    /// Turns the marker colours of an SVG text into CSS variables.
    pub(in crate::plot) fn replace_markers(svg: &str) -> String {
        let dashed = (0..N_DATA_INKS).map(Self::Dashed);
        let all = [Self::Text, Self::Muted, Self::Grid]
            .into_iter()
            .chain((0..N_DATA_INKS).map(Self::Data))
            .chain(dashed)
            .chain((0..named::N_NAMED).map(Self::Named));
        all.fold(svg.to_owned(), |svg, ink| {
            svg.replace(&format!("\"#F00D{:02X}\"", ink.code()), &ink.attribute())
        })
    }

    fn code(self) -> u8 {
        match self {
            Self::Text => 0x80,
            Self::Muted => 0x81,
            Self::Grid => 0x82,
            Self::Data(index) => index % N_DATA_INKS,
            Self::Dashed(index) => 0x10 + index % N_DATA_INKS,
            Self::Named(index) => 0x20 + index % named::N_NAMED,
        }
    }

    /// The quoted attribute value, with the dash pattern behind it (tenths of a pixel).
    fn attribute(self) -> String {
        match self {
            Self::Text => "\"var(--text)\"".to_owned(),
            Self::Muted => "\"var(--muted)\"".to_owned(),
            Self::Grid => "\"var(--grid)\"".to_owned(),
            Self::Data(index) => format!("\"var(--ink-{index})\""),
            Self::Dashed(index) => format!("\"var(--ink-{index})\" stroke-dasharray=\"50 35\""),
            Self::Named(index) => named::attribute(index),
        }
    }
}
