use anyhow::Result;
use wayfix_evaluation::plot::{FilmStrip, FilmStripFrame, LinePlot, PlotSeries, SvgPlot};
use wayfix_sensor_log::EncodedImage;
use wayfix_systems::views::{DescriptorKind, shade};

use super::{
    figures::Variants,
    localize::LocalizationRun,
    traverses::{Frame, Traverses},
};

/// Pixels a frame and a place of a belief map.
const CELL: usize = 4;
/// Frames between the marks of the truth.
const MARK_EVERY: usize = 10;
/// Columns of the film strip.
const FILM_FRAMES: usize = 6;
const TRUTH: [u8; 3] = [214, 39, 40];

/// Belief frame by frame, error of the best place, and the frames with their matches.
pub(super) fn plots(traverses: &Traverses, variants: &[(DescriptorKind, Variants)]) -> Result<Vec<SvgPlot>> {
    let mut plots = vec![beliefs(variants)?, errors(variants).draw()?];
    if let Some((kind, best)) = variants.last() {
        plots.push(film(traverses, *kind, &best.filtered)?);
    }
    Ok(plots)
}

fn beliefs(variants: &[(DescriptorKind, Variants)]) -> Result<SvgPlot> {
    let mut film = FilmStrip { title: "Belief along the corridor".to_owned(), ..FilmStrip::default() };
    let mut frames = Vec::new();
    for (kind, variants) in variants {
        let (size, pixels) = belief_map(&variants.filtered.beliefs);
        film.frame_size = size;
        let image = EncodedImage::png_rgb(size.0, size.1, &pixels)?;
        frames.push(FilmStripFrame { image, caption: kind.title().to_owned() });
    }
    film.rows = vec![("frames to the right, places up; dark: probable, red: true".to_owned(), frames)];
    Ok(film.draw()?)
}

/// A column a frame, a row a place, the first at the bottom; every tenth true place is marked.
fn belief_map(beliefs: &[Vec<f64>]) -> ((u32, u32), Vec<u8>) {
    let n_places = beliefs.first().map_or(0, Vec::len);
    let (width, height) = (beliefs.len() * CELL, n_places * CELL);
    let pixel = |i: usize| {
        let (frame, place) = (i % width / CELL, n_places - 1 - i / width / CELL);
        let most = beliefs[frame].iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let is_near = |at: usize| at.abs_diff((frame + 1) / MARK_EVERY * MARK_EVERY) <= 1;
        let is_marked = is_near(frame) && is_near(place);
        if is_marked { TRUTH } else { shade(beliefs[frame][place] / most) }
    };
    ((width as u32, height as u32), (0..width * height).flat_map(pixel).collect())
}

fn errors(variants: &[(DescriptorKind, Variants)]) -> LinePlot {
    let series = |(kind, variants): &(DescriptorKind, Variants)| {
        let points = variants.filtered.errors().enumerate().map(|(frame, off)| (frame as f64, off as f64));
        PlotSeries::new(kind.title(), points.collect())
    };
    LinePlot {
        title: "Error of the most probable place".to_owned(),
        x_label: "frame".to_owned(),
        y_label: "places".to_owned(),
        series: variants.iter().map(series).collect(),
        ..LinePlot::default()
    }
}

fn film(traverses: &Traverses, kind: DescriptorKind, journey: &LocalizationRun) -> Result<SvgPlot> {
    let (mut seen, mut believed) = (Vec::new(), Vec::new());
    let film_frame = |frame: &Frame, caption| FilmStripFrame { image: frame.image.clone(), caption };
    for k in 0..FILM_FRAMES {
        let at = traverses.seen.len() * k / FILM_FRAMES;
        let place = journey.best[at];
        seen.push(film_frame(&traverses.seen[at], format!("frame {at}")));
        believed.push(film_frame(&traverses.learned[place], format!("place {place}")));
    }
    let size = &traverses.seen[0].picture;
    let film = FilmStrip {
        title: format!("The robot's view, and its most probable place ({})", kind.title()),
        rows: vec![("seen".to_owned(), seen), ("learned there".to_owned(), believed)],
        frame_size: (size.width(), size.height()),
    };
    Ok(film.draw()?)
}
