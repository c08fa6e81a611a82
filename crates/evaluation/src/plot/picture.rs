use serde::{Deserialize, Serialize};

use super::svg::ink::{DARK_PALETTE, LIGHT_PALETTE};
use super::svg::named::named_palette;

/// A drawn plot: an inline `<svg>` element whose colours are the CSS variables of the page around it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SvgPlot {
    /// Caption.
    pub title: String,
    /// Alternative text for readers who cannot see the picture.
    pub alt: String,
    /// Natural width, CSS pixels.
    pub width: u32,
    /// Natural height, CSS pixels.
    pub height: u32,
    /// The `<svg>` element, well-formed XML; not stored in `report.json`.
    #[serde(skip)]
    pub svg: String,
}

impl SvgPlot {
    /// The picture as a separate file: the same element with the palette inside.
    /// ```
    /// use wayfix_evaluation::plot::{LinePlot, PlotSeries};
    /// let plot = LinePlot { series: vec![PlotSeries::new("speed", vec![(0.0, 1.0), (1.0, 3.0)])], ..Default::default() };
    /// assert!(plot.draw()?.standalone().contains("prefers-color-scheme: dark"));
    /// # Ok::<(), wayfix_evaluation::plot::PlotError>(())
    /// ```
    pub fn standalone(&self) -> String {
        let [light, dark] = [false, true].map(named_palette);
        let style = format!(
            "<style>svg{{{LIGHT_PALETTE}{light};background:var(--paper)}}text{{font-family:system-ui,sans-serif}}\
             @media (prefers-color-scheme: dark){{svg{{{DARK_PALETTE}{dark}}}}}</style>"
        );
        match self.svg.find('>') {
            Some(end) => format!("{}{style}{}", &self.svg[..=end], &self.svg[end + 1..]),
            None => String::new(),
        }
    }
}
