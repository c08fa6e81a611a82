use std::cmp::Reverse;

use anyhow::Result;
use wayfix_condensation::{PositionGrid, RgbImage, StateDescriptorTable};
use wayfix_evaluation::plot::{FilmStrip, FilmStripFrame, LinePlot, PlotSeries, SvgPlot};
use wayfix_sensor_log::{EncodedImage, ImageError};

use super::{DescriptorKind, ViewSystem, ViewTrial, ViewTrialStep, ViewsRun};

/// Moves after which the belief is shown, besides the last.
const SHOWN: [usize; 5] = [0, 1, 2, 6, 16];
/// Film frames per row; there are two rows.
const FRAMES_A_ROW: usize = 3;
/// Pixels per place of a belief map.
pub(super) const CELL: usize = 12;
pub(super) const TRUTH: [u8; 3] = [214, 39, 40];
pub(super) const GOAL: [u8; 3] = [24, 140, 60];
pub(super) const BEST: [u8; 3] = [240, 160, 0];
pub(super) const JPEG_QUALITY: u8 = 85;

/// Plots the learned and the real scene, the belief in the drive that was uncertain for longest, and the convergence of all drives. [Kasprzak & Szynkiewicz, Fig. 4]
///
/// # Errors
/// Returns an error if a picture cannot be encoded or drawn.
pub fn plots(run: &ViewsRun, learned: &RgbImage, real: &RgbImage, seed: u64) -> Result<Vec<SvgPlot>> {
    Ok(vec![
        scenes(learned, real)?,
        belief_film(&run.system, seed, slowest(&run.trials))?,
        certainty(&run.trials).draw()?,
        feature_plot(run.system.learned(), run.system.feature())?,
    ])
}

/// The first three components of the feature over the places. [Kasprzak & Szynkiewicz, Fig. 5]
///
/// # Errors
/// Returns an error if it cannot be drawn.
pub fn feature_plot(learned: &StateDescriptorTable, feature: DescriptorKind) -> Result<SvgPlot> {
    let component = |k: usize| {
        let points = learned.rows().enumerate().map(|(state, row)| (state as f64, row[k])).collect();
        PlotSeries::new(format!("component {}", k + 1), points)
    };
    let plot = LinePlot {
        title: format!("The first three components of {} over the places", feature.title()),
        x_label: "place, row by row".to_owned(),
        y_label: "feature".to_owned(),
        series: (0..learned.n_components().min(3)).map(component).collect(),
        ..LinePlot::default()
    };
    Ok(plot.draw()?)
}

/// Belief over the places after 0, 1, 2, 6 and 16 moves and at the end of a trial. [Kasprzak & Szynkiewicz, Fig. 6]
///
/// # Errors
/// Returns an error if the trial cannot be driven or an image cannot be encoded.
pub fn belief_film(system: &ViewSystem, seed: u64, trial: u64) -> Result<SvgPlot> {
    let grid = *system.views().grid();
    let mut maps = Vec::new();
    let mut last = None;
    system.trial(seed, trial, |step| {
        let map = belief_image(&grid, &step);
        if SHOWN.contains(&step.number) {
            maps.push((step.number, map));
            last = None;
        } else {
            last = Some((step.number, map));
        }
    })?;
    maps.extend(last);
    let size = ((grid.columns() * CELL) as u32, (grid.rows() * CELL) as u32);
    let frame = |(number, image): (usize, Result<EncodedImage, ImageError>)| {
        Ok(FilmStripFrame { image: image?, caption: format!("{number} moves") })
    };
    let frames: Vec<FilmStripFrame> = maps.into_iter().map(frame).collect::<Result<_, ImageError>>()?;
    let legends =
        ["red: true place, orange: best, green: goal", "dark: probable, by the logarithm to a millionth"];
    let rows =
        frames.chunks(FRAMES_A_ROW).zip(legends).map(|(frames, legend)| (legend.to_owned(), frames.to_vec()));
    let film = FilmStrip {
        title: format!("Belief over the places, trial {trial}"),
        rows: rows.collect(),
        frame_size: size,
    };
    Ok(film.draw()?)
}

/// The belief after a step, with the true place, the best and the goal.
pub(super) fn belief_image(
    grid: &PositionGrid,
    step: &ViewTrialStep<'_>,
) -> Result<EncodedImage, ImageError> {
    let marks = [(step.goal, GOAL), (step.localizer.best().state, BEST), (step.at, TRUTH)];
    let pixels = belief_map(grid, step.localizer.belief(), &marks);
    EncodedImage::png_rgb((grid.columns() * CELL) as u32, (grid.rows() * CELL) as u32, &pixels)
}

/// One square per place, darker for larger belief. The marks of one place are nested, the last outermost.
pub(super) fn belief_map(grid: &PositionGrid, belief: &[f64], marks: &[(usize, [u8; 3])]) -> Vec<u8> {
    let most = belief.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let width = grid.columns() * CELL;
    let pixel = |i: usize| {
        let (x, y) = (i % width, i / width);
        let place = grid.state(x / CELL, y / CELL).unwrap_or(0);
        let border = [x % CELL, y % CELL].into_iter().map(|at| at.min(CELL - 1 - at)).min().unwrap_or(0);
        let mark = marks.iter().rev().filter(|mark| mark.0 == place).nth(border / 2);
        mark.map_or_else(|| shade(belief[place] / most), |mark| mark.1)
    };
    (0..width * grid.rows() * CELL).flat_map(pixel).collect()
}

/// White for 0, dark blue for 1, logarithmic in between down to 1e-6.
pub fn shade(share: f64) -> [u8; 3] {
    const PAPER: [f64; 3] = [246.0, 247.0, 249.0];
    const INK: [f64; 3] = [8.0, 48.0, 107.0];
    let depth = (1.0 + share.max(f64::MIN_POSITIVE).log10() / 6.0).clamp(0.0, 1.0);
    std::array::from_fn(|c| (PAPER[c] + depth * (INK[c] - PAPER[c])).round() as u8)
}

/// The trial that became certain last; one that never did is the slowest.
pub(super) fn slowest(trials: &[ViewTrial]) -> u64 {
    let steps = |trial: &ViewTrial| trial.report.steps_to_certainty.unwrap_or(usize::MAX);
    let slowest = trials.iter().max_by_key(|trial| (steps(trial), Reverse(trial.index)));
    slowest.map_or(0, |trial| trial.index)
}

fn scenes(learned: &RgbImage, real: &RgbImage) -> Result<SvgPlot> {
    let size = learned.dimensions();
    let frame = |picture: &RgbImage, caption: &str| -> Result<FilmStripFrame> {
        let image = EncodedImage::jpeg(size.0, size.1, picture.as_raw(), JPEG_QUALITY)?;
        Ok(FilmStripFrame { image, caption: caption.to_owned() })
    };
    let frames = vec![frame(learned, "learned")?, frame(real, "seen")?];
    let film = FilmStrip {
        title: "The scene".to_owned(),
        rows: vec![("the robot sees a window of it at a time".to_owned(), frames)],
        frame_size: size,
    };
    Ok(film.draw()?)
}

/// Growth of the belief in the true place over the drives.
fn certainty(trials: &[ViewTrial]) -> LinePlot {
    let n_moves = trials.iter().map(|trial| trial.belief_in_truth.len()).max().unwrap_or(0);
    // A finished drive keeps its last value.
    let at = |trial: &ViewTrial, moves: usize| {
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
    LinePlot {
        title: "How many drives find the true place".to_owned(),
        x_label: "moves".to_owned(),
        y_label: "share of the drives".to_owned(),
        series: vec![
            PlotSeries::new("belief above 0.5", share(0.5)),
            PlotSeries::new("above 0.9", share(0.9)),
            PlotSeries::new("above 0.999", share(0.999)),
        ],
        ..LinePlot::default()
    }
}
