use nalgebra::Vector2;
use rand::Rng;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

use super::super::color::grey;
use super::super::light::{LightField, LightGroup, LightKind};
use super::super::panel::{Material, Panel, sides, walls};
use super::aisles::AisleGrid;
use super::building::Building;
use super::decor::{curtain, outside, stand, wall};
use crate::random::deviate::{chance, uniform};
use crate::{SimulationError, check};

/// Extent along x and y, metres. [Gross et al. 2005, Table 1]
const SIZE_M: [f64; 2] = [15.0, 10.0];
const CEILING_M: f64 = 3.0;
/// Windows along the wall of high y, and their lower and upper edge, m.
const WINDOWS_M: [[f64; 2]; 4] = [[-7.0, -4.0], [-3.4, -0.4], [0.4, 3.4], [4.0, 7.0]];
const SILL_M: [f64; 2] = [0.9, 2.5];
/// Middles of the ways, metres.
const XS_M: [f64; 4] = [-6.3, -2.1, 2.1, 6.3];
const YS_M: [f64; 3] = [-3.7, 0.0, 3.7];
/// Half the extent of a group of desks, metres.
const DESKS_M: [f64; 2] = [1.3, 0.9];

/// A laboratory with desks, windows, curtains and three groups of lamps.
///
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_scene_sim::indoors::Laboratory;
/// let mut rng = ChaCha8Rng::seed_from_u64(1);
/// let lab = Laboratory::draw(&mut rng);
/// assert!((lab.building().size_m().x - 15.0).abs() < 1e-12);
/// assert!(lab.rearranged(0.5, &mut rng)? != lab);
/// # Ok::<(), wayfix_scene_sim::SimulationError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Laboratory {
    /// Decides walls, windows and curtains.
    decor: u64,
    /// Objects on each group of desks.
    desks: [u64; 6],
}

impl Laboratory {
    /// Random furniture.
    pub fn draw<R: Rng + ?Sized>(rng: &mut R) -> Self {
        Self { decor: rng.next_u64(), desks: std::array::from_fn(|_| rng.next_u64()) }
    }

    /// The same with other things on a share of the desks.
    ///
    /// # Errors
    /// Returns an error if the share is none.
    pub fn rearranged<R: Rng + ?Sized>(&self, share: f64, rng: &mut R) -> Result<Self, SimulationError> {
        check::share("share of the desks that are rearranged", share)?;
        let mut later = self.clone();
        for desk in &mut later.desks {
            if chance(share, rng) {
                *desk = rng.next_u64();
            }
        }
        Ok(later)
    }

    /// Builds it up.
    pub fn building(&self) -> Building {
        let mut rng = ChaCha8Rng::seed_from_u64(self.decor);
        let size = Vector2::from(SIZE_M);
        let mut room = Building {
            size,
            ceiling_m: CEILING_M,
            floor: [120, 110, 100],
            ceiling: grey(200),
            panels: Vec::new(),
            textures: Vec::new(),
            light: LightField::new(size, &lights()),
            n_lamps: 3,
            n_curtains: WINDOWS_M.len(),
            aisles: AisleGrid { xs: XS_M.into(), ys: YS_M.into(), max_lateral_offset_m: 0.25, turn_m: 0.6 },
        };
        for (k, (left, right)) in walls(-0.5 * size, 0.5 * size).into_iter().enumerate() {
            let texture = wall((right - left).norm(), CEILING_M, 0.1 + 0.2 * k as f64, &mut rng);
            room.put(left, right, [0.0, CEILING_M], texture);
        }
        for (number, span) in WINDOWS_M.into_iter().enumerate() {
            put_window(&mut room, number, span, &mut rng);
        }
        for (number, desks) in self.desks.iter().enumerate() {
            let middle = [number % 3, number / 3];
            let centre = 0.5
                * Vector2::new(XS_M[middle[0]] + XS_M[middle[0] + 1], YS_M[middle[1]] + YS_M[middle[1] + 1]);
            put_desks(&mut room, centre, &mut ChaCha8Rng::seed_from_u64(*desks));
        }
        room
    }
}

/// Slightly in front of the wall, so that it hides it.
fn put_window<R: Rng + ?Sized>(room: &mut Building, number: usize, [from, to]: [f64; 2], rng: &mut R) {
    let (length_m, height_m) = (to - from, SILL_M[1] - SILL_M[0]);
    let y = 0.5 * SIZE_M[1] - 0.1;
    let (left, right) = (Vector2::new(from, y), Vector2::new(to, y));
    room.textures.extend([outside(length_m, height_m, rng), curtain(length_m, height_m, rng)]);
    let outside = room.textures.len() - 2;
    let material = Material::Window { outside, curtain: outside + 1, number };
    room.panels.push(Panel { left, right, bottom_m: SILL_M[0], top_m: SILL_M[1], material });
}

/// A table with screens, boxes and bags on it.
fn put_desks<R: Rng + ?Sized>(room: &mut Building, centre: Vector2<f64>, rng: &mut R) {
    let half = Vector2::from(DESKS_M);
    for (left, right) in sides(centre - half, centre + half) {
        let texture = stand((right - left).norm(), 0.75, rng);
        room.put(left, right, [0.0, 0.75], texture);
    }
    for _ in 0..5 {
        let at = centre + Vector2::new(uniform(-0.9, 0.9, rng), uniform(-0.6, 0.6, rng));
        let half = Vector2::new(uniform(0.1, 0.35, rng), uniform(0.1, 0.3, rng));
        let top = uniform(1.0, 1.5, rng);
        for (left, right) in sides(at - half, at + half) {
            let texture = stand((right - left).norm(), top - 0.75, rng);
            room.put(left, right, [0.75, top], texture);
        }
    }
}

/// Three groups of lamps along x, and the windows.
fn lights() -> Vec<LightGroup> {
    let lamps = (0..3).map(|number| LightGroup {
        kind: LightKind::Lamps(number),
        color: [0.45, 0.42, 0.36],
        places: [-2.5, 2.5].map(|y| Vector2::new(5.0 * (number as f64 - 1.0), y)).into(),
        reach_m: 2.5,
    });
    let windows = WINDOWS_M.into_iter().enumerate().map(|(number, [from, to])| LightGroup {
        kind: LightKind::Window(number),
        color: [0.45, 0.5, 0.6],
        places: vec![Vector2::new(0.5 * (from + to), 0.5 * SIZE_M[1])],
        reach_m: 3.0,
    });
    lamps.chain(windows).collect()
}
