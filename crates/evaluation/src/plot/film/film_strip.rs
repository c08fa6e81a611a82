use std::fmt::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use wayfix_sensor_log::EncodedImage;

use crate::plot::svg::canvas::FONT_SIZE;
use crate::plot::svg::layout::{WIDTH, no_data};
use crate::plot::svg::markup::escape;
use crate::plot::{PlotError, SvgPlot};

/// Rows of images of one size: camera images and results.
///
/// The images are embedded in the drawing, so the page needs no other file.
#[derive(Clone, Debug, Default)]
pub struct FilmStrip {
    /// Caption.
    pub title: String,
    /// Title of each row, with its frames from left to right.
    pub rows: Vec<(String, Vec<FilmStripFrame>)>,
    /// Width and height of a frame in its own pixels.
    pub frame_size: (u32, u32),
}

/// One frame of a strip.
#[derive(Clone, Debug)]
pub struct FilmStripFrame {
    /// The picture.
    pub image: EncodedImage,
    /// A word or two below it.
    pub caption: String,
}

const GAP: f64 = 6.0;
const LINE: f64 = 20.0;

impl FilmStrip {
    /// The picture.
    ///
    /// # Errors
    /// Returns an error if the drawing library refuses; only an empty strip needs it.
    pub fn draw(&self) -> Result<SvgPlot, PlotError> {
        let n_columns = self.rows.iter().map(|(_, frames)| frames.len()).max().unwrap_or(0);
        let (frame_width, frame_height) = self.frame_size;
        if n_columns == 0 || frame_width == 0 || frame_height == 0 {
            return no_data(&self.title);
        }
        let width = (WIDTH - GAP * (n_columns - 1) as f64) / n_columns as f64;
        let height = width * f64::from(frame_height) / f64::from(frame_width);
        let row_height = LINE + height + LINE;
        let total = row_height * self.rows.len() as f64;
        let headings = self.rows.iter().map(|(heading, _)| heading.as_str()).filter(|text| !text.is_empty());
        let headings: Vec<&str> = std::iter::once(self.title.as_str()).chain(headings).collect();
        let alt = headings.join("; ");
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{total:.0}\" viewBox=\"0 0 {WIDTH} {total:.0}\" \
             role=\"img\" aria-label=\"{}\" font-size=\"{FONT_SIZE}\">\n",
            escape(&alt)
        );
        for (row, (heading, frames)) in self.rows.iter().enumerate() {
            let top = row as f64 * row_height;
            write_text(&mut svg, 0.0, top + 0.7 * LINE, heading);
            for (column, frame) in frames.iter().enumerate() {
                let left = column as f64 * (width + GAP);
                let _ = writeln!(
                    svg,
                    "<image x=\"{left:.1}\" y=\"{:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" \
                     href=\"data:{};base64,{}\"/>",
                    top + LINE,
                    frame.image.media_type(),
                    STANDARD.encode(&*frame.image.bytes)
                );
                write_text(&mut svg, left, top + LINE + height + 0.75 * LINE, &frame.caption);
            }
        }
        svg.push_str("</svg>\n");
        let (width, height) = (WIDTH.round() as u32, total.round() as u32);
        Ok(SvgPlot { title: self.title.clone(), alt, width, height, svg })
    }
}

fn write_text(svg: &mut String, x: f64, y: f64, text: &str) {
    if text.is_empty() {
        return; // Screen readers announce an empty text.
    }
    let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\" fill=\"var(--muted)\">{}</text>", escape(text));
}
