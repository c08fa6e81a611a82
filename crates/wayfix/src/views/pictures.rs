use anyhow::Result;
use wayfix_condensation::{Grid, Picture as Pixels};
use wayfix_sensor_log::EncodedImage;

use super::{Trial, ViewSystem, ViewsRun};
use crate::plot::{FilmFrame, FilmStrip, LinesPlot, Picture, Series};

/// Moves after which Fig. 6 and we show the belief.
const SHOWN: [usize; 4] = [0, 2, 6, 16];
/// Pixels a place of a belief map.
const CELL: usize = 12;
const TRUTH: [u8; 3] = [214, 39, 40];
const GOAL: [u8; 3] = [24, 140, 60];
const BEST: [u8; 3] = [240, 160, 0];
const JPEG_QUALITY: u8 = 85;

/// The scene learned and seen, the belief in a drive, and how fast the drives became certain.
///
/// # Errors
/// When a picture cannot be encoded or drawn.
pub fn pictures(run: &ViewsRun, learned: &Pixels, real: &Pixels, seed: u64) -> Result<Vec<Picture>> {
    Ok(vec![scenes(learned, real)?, belief_film(&run.system, seed, 0)?, certainty(&run.trials).draw()?])
}

/// Belief over the places after 0, 2, 6 and 16 moves and at the end of a trial. [Kasprzak & Szynkiewicz, Fig. 6]
///
/// # Errors
/// When the trial cannot be driven or a picture not be encoded.
pub fn belief_film(system: &ViewSystem, seed: u64, trial: u64) -> Result<Picture> {
    let grid = *system.views().grid();
    let mut maps: Vec<(usize, Vec<u8>)> = Vec::new();
    let mut last = None;
    system.trial(seed, trial, |step| {
        let marks = [(step.goal, GOAL), (step.localizer.best().state, BEST), (step.at, TRUTH)];
        let map = belief_map(&grid, step.localizer.belief(), &marks);
        if SHOWN.contains(&step.number) {
            maps.push((step.number, map));
            last = None;
        } else {
            last = Some((step.number, map));
        }
    })?;
    maps.extend(last);
    let size = ((grid.columns() * CELL) as u32, (grid.rows() * CELL) as u32);
    let frame = |(number, map): (usize, Vec<u8>)| -> Result<FilmFrame> {
        let image = EncodedImage::png_rgb(size.0, size.1, &map)?;
        Ok(FilmFrame { image, caption: format!("{number} moves") })
    };
    let frames = maps.into_iter().map(frame).collect::<Result<_>>()?;
    let heading = "dark: believed; red frame: true place, orange: best place, green: goal".to_owned();
    let film = FilmStrip {
        title: format!("Belief over the places, trial {trial}"),
        rows: vec![(heading, frames)],
        frame_size: size,
    };
    Ok(film.draw()?)
}

/// A square a place, darker where belief is larger; of marks at one place the last is seen, and the others around it.
fn belief_map(grid: &Grid, belief: &[f64], marks: &[(usize, [u8; 3])]) -> Vec<u8> {
    const PAPER: [f64; 3] = [246.0, 247.0, 249.0];
    const INK: [f64; 3] = [8.0, 48.0, 107.0];
    let most = belief.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let width = grid.columns() * CELL;
    let pixel = |i: usize| {
        let (x, y) = (i % width, i / width);
        let place = grid.state(x / CELL, y / CELL).unwrap_or(0);
        let border = [x % CELL, y % CELL].into_iter().map(|at| at.min(CELL - 1 - at)).min().unwrap_or(0);
        // The marks of one place lie inside each other, two pixels wide.
        let here = marks.iter().rev().filter(|mark| mark.0 == place).map(|mark| mark.1);
        if let Some(color) = here.take(CELL / 4).nth(border / 2) {
            return color;
        }
        let share = (belief[place] / most).sqrt();
        std::array::from_fn(|c| (PAPER[c] + share * (INK[c] - PAPER[c])).round() as u8)
    };
    (0..width * grid.rows() * CELL).flat_map(pixel).collect()
}

fn scenes(learned: &Pixels, real: &Pixels) -> Result<Picture> {
    let size = (learned.width() as u32, learned.height() as u32);
    let frame = |picture: &Pixels, caption: &str| -> Result<FilmFrame> {
        let image = EncodedImage::jpeg(size.0, size.1, picture.pixels().as_flattened(), JPEG_QUALITY)?;
        Ok(FilmFrame { image, caption: caption.to_owned() })
    };
    let frames = vec![frame(learned, "learned")?, frame(real, "seen")?];
    let film = FilmStrip {
        title: "The scene".to_owned(),
        rows: vec![("the robot sees a window of it at a time".to_owned(), frames)],
        frame_size: size,
    };
    Ok(film.draw()?)
}

/// How belief in the true place grows over the drives.
fn certainty(trials: &[Trial]) -> LinesPlot {
    let n_moves = trials.iter().map(|trial| trial.belief_in_truth.len()).max().unwrap_or(0);
    // A drive that is over keeps what it ended with.
    let at = |trial: &Trial, moves: usize| {
        let last = trial.belief_in_truth.len().saturating_sub(1);
        trial.belief_in_truth.get(moves.min(last)).copied().unwrap_or(f64::NAN)
    };
    let share = |belief: f64| {
        let of = |moves: usize| {
            let n = trials.iter().filter(|trial| at(trial, moves) >= belief).count();
            (moves as f64, n as f64 / trials.len().max(1) as f64)
        };
        (0..n_moves).map(of).collect()
    };
    LinesPlot {
        title: "How many drives believe in the true place".to_owned(),
        x_label: "moves".to_owned(),
        y_label: "share of the drives".to_owned(),
        series: vec![
            Series::new("belief above 0.5", share(0.5)),
            Series::new("above 0.9", share(0.9)),
            Series::new("above 0.999", share(0.999)),
        ],
        ..LinesPlot::default()
    }
}
