use super::color_channels::{N_COLOR, color_channels};
use super::gradient_channels::{N_GRADIENT, gradient_channels};
use super::lane::LANES;
use super::patch::Patch;
use super::planes::Planes;

/// Pixels along a cell of the grid of features.
pub(in crate::correlation) const CELL: usize = 4;

/// Weights of the kinds of channels in the energy of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::correlation) struct Shares {
    pub(in crate::correlation) gradient: f32,
    pub(in crate::correlation) grey: f32,
    pub(in crate::correlation) color: f32,
}

/// Gradient, grey and colour channels of a square patch, tapered towards the border. Each kind has its share of a total energy of 1.
///
/// A uniform patch gives zeros.
pub(in crate::correlation) fn features(patch: &Patch, taper: &[f32], shares: Shares) -> Planes {
    let side = patch.width / CELL;
    let n_cells = side * side;
    let with_color = shares.color > 0.0;
    let n_groups = N_GRADIENT.div_ceil(LANES) + usize::from(with_color);
    let mut planes = Planes::zeros(side, n_groups);
    let gradients = gradient_channels(patch, CELL);
    let colors = color_channels(patch, CELL);
    let mean_grey = colors.iter().map(|(_, grey)| grey).sum::<f32>() / n_cells as f32;
    let mean_color: [f32; N_COLOR] =
        std::array::from_fn(|c| colors.iter().map(|(classes, _)| classes[c]).sum::<f32>() / n_cells as f32);

    for i in 0..n_cells {
        for (c, value) in gradients[i].iter().enumerate() {
            planes.cells[(c / LANES) * n_cells + i][c % LANES] = value * taper[i];
        }
        let (classes, grey) = &colors[i];
        planes.cells[(N_GRADIENT / LANES) * n_cells + i][N_GRADIENT % LANES] = (grey - mean_grey) * taper[i];
        if with_color {
            let cell = &mut planes.cells[(n_groups - 1) * n_cells + i];
            for c in 0..N_COLOR {
                cell[c] = (classes[c] - mean_color[c]) * taper[i];
            }
        }
    }
    share_energy(&mut planes, shares);
    planes
}

/// Scales each kind of channel to its share of the energy.
fn share_energy(planes: &mut Planes, shares: Shares) {
    let n_cells = planes.side * planes.side;
    let kind = |group: usize, c: usize| match group * LANES + c {
        0..N_GRADIENT => 0,
        N_GRADIENT => 1,
        _ => 2,
    };
    let mut energy = [0.0_f64; 3];
    for (i, cell) in planes.cells.iter().enumerate() {
        for (c, value) in cell.iter().enumerate() {
            energy[kind(i / n_cells, c)] += f64::from(value * value);
        }
    }
    let shares = [shares.gradient, shares.grey, shares.color];
    let total: f32 = shares.iter().sum();
    let scale: [f32; 3] = std::array::from_fn(|k| {
        if energy[k] > 1e-6 { (f64::from(shares[k] / total) / energy[k]).sqrt() as f32 } else { 0.0 }
    });
    for (i, cell) in planes.cells.iter_mut().enumerate() {
        for (c, value) in cell.iter_mut().enumerate() {
            *value *= scale[kind(i / n_cells, c)];
        }
    }
}
