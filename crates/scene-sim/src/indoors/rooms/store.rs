use nalgebra::Vector2;
use rand::Rng;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

use super::super::color::grey;
use super::super::light::{LightField, LightGroup, LightKind};
use super::super::panel::{Material, Panel, sides, walls};
use super::aisles::AisleGrid;
use super::building::Building;
use super::decor::{outside, stand, wall};
use super::shelf::{Assortment, Section};
use super::store_params::RetailStoreParams;
use crate::SimulationError;
use crate::check;
use crate::random::deviate::{below, chance};

/// Height of the hall, metres.
const CEILING_M: f64 = 6.0;
/// Edges and height of a stand with special offers, metres.
const STAND_M: [f64; 2] = [0.6, 1.3];
/// Maximum offset of a robot from the middle of an aisle, as a share of the aisle.
const PLAY: f64 = 0.15;

/// A store on one day: rows of shelves and their goods.
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_scene_sim::indoors::{RetailStore, RetailStoreParams};
/// let mut rng = ChaCha8Rng::seed_from_u64(1);
/// let today = RetailStore::draw(RetailStoreParams::area(), &mut rng)?;
/// let later = today.rearranged(0.4, &mut rng)?;
/// assert!(today != later && today.building() == today.clone().building());
/// # Ok::<(), wayfix_scene_sim::SimulationError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RetailStore {
    params: RetailStoreParams,
    /// Selects the assortment, the walls and the objects in front of the windows.
    decor: u64,
    /// Shelf by shelf, the front of low y, then that of high y; then the two ends.
    fronts: Vec<[Vec<Section>; 4]>,
    /// Stands before the low and the high end of each shelf, and their appearance.
    stands: Vec<[Option<u64>; 2]>,
}

impl RetailStore {
    /// A store of this size with random goods.
    ///
    /// # Errors
    /// Returns [`SimulationError::Parameter`] or [`SimulationError::TooMany`] if a parameter is out of range.
    pub fn draw<R: Rng + ?Sized>(params: RetailStoreParams, rng: &mut R) -> Result<Self, SimulationError> {
        params.validate()?;
        let decor = rng.next_u64();
        let mut store = Self { params, decor, fronts: Vec::new(), stands: Vec::new() };
        let mut known: Vec<u64> = Vec::new();
        for row in 0..params.n_rows() {
            for block in 0..params.n_blocks {
                let mut front = |side: usize, n: usize| {
                    let department = ((row + side).div_ceil(2) + 3 * block) % params.n_departments;
                    (0..n)
                        .map(|_| Section {
                            department: department as u8,
                            goods: Some(goods(&mut known, rng)),
                        })
                        .collect()
                };
                let n = params.n_sections();
                store.fronts.push([front(0, n), front(1, 1), front(1, n), front(0, 1)]);
                let mut stand = || chance(params.end_display_share, rng).then(|| rng.next_u64());
                store.stands.push([stand(), stand()]);
            }
        }
        Ok(store)
    }

    /// The same store some weeks later. With probability `share` each section gets other goods (6 of 10), is exchanged with another (3) or
    /// cleared (1); a cleared one is filled again. Each stand is added or removed with half of that probability.
    /// # Errors
    /// Returns [`SimulationError::Parameter`] if `share` is not in [0, 1].
    pub fn rearranged<R: Rng + ?Sized>(&self, share: f64, rng: &mut R) -> Result<Self, SimulationError> {
        check::share("share of the sections that are rearranged", share)?;
        let mut later = self.clone();
        for shelf in 0..later.fronts.len() {
            for side in 0..4 {
                for place in 0..later.fronts[shelf][side].len() {
                    if chance(share, rng) {
                        later.rearrange([shelf, side, place], rng);
                    }
                }
            }
            for end in &mut later.stands[shelf] {
                if chance(0.5 * share, rng) {
                    *end = if end.is_some() { None } else { Some(rng.next_u64()) };
                }
            }
        }
        Ok(later)
    }

    fn rearrange<R: Rng + ?Sized>(&mut self, [shelf, side, place]: [usize; 3], rng: &mut R) {
        let section = self.fronts[shelf][side][place];
        match below(10, rng) {
            0 if section.goods.is_some() => self.fronts[shelf][side][place].goods = None,
            0..7 => self.fronts[shelf][side][place].goods = Some(rng.next_u64()),
            _ => {
                let other = below(self.fronts.len(), rng);
                let at = below(self.fronts[other][side].len(), rng);
                self.fronts[shelf][side][place] =
                    std::mem::replace(&mut self.fronts[other][side][at], section);
            }
        }
    }

    /// Builds it up.
    pub fn building(&self) -> Building {
        let mut rng = ChaCha8Rng::seed_from_u64(self.decor);
        let assortment = Assortment::draw(self.params.n_departments, &mut rng);
        let mut shop = Building {
            size: Vector2::new(self.params.length_m, self.params.width_m),
            ceiling_m: CEILING_M,
            floor: grey(140),
            ceiling: grey(120),
            panels: Vec::new(),
            textures: Vec::new(),
            light: LightField::new(Vector2::new(self.params.length_m, self.params.width_m), &self.lights()),
            n_lamps: self.params.n_rows() + 1,
            n_curtains: 1,
            aisles: self.aisles(),
        };
        self.put_walls(&mut shop, &mut rng);
        for (shelf, (fronts, stands)) in self.fronts.iter().zip(&self.stands).enumerate() {
            let (low, high) = self.params.shelf(shelf);
            for ((left, right), sections) in sides(low, high).into_iter().zip(fronts) {
                let texture = assortment.front(sections, self.params.shelf_height_m);
                shop.put(left, right, [0.0, self.params.shelf_height_m], texture);
            }
            self.put_stands(&mut shop, [low, high], stands);
        }
        shop
    }

    /// Posters and paint all around; the end of high x is glazed.
    fn put_walls<R: Rng + ?Sized>(&self, shop: &mut Building, rng: &mut R) {
        let half = 0.5 * shop.size;
        for (k, (left, right)) in walls(-half, half).into_iter().enumerate() {
            let length_m = (right - left).norm();
            let texture = wall(length_m, CEILING_M, 0.15 * k as f64, rng);
            if k == 1 {
                shop.textures.extend([outside(length_m, CEILING_M, rng), texture]);
                let outside = shop.textures.len() - 2;
                let material = Material::Window { outside, curtain: outside + 1, number: 0 };
                shop.panels.push(Panel { left, right, bottom_m: 0.0, top_m: CEILING_M, material });
            } else {
                shop.put(left, right, [0.0, CEILING_M], texture);
            }
        }
    }

    fn put_stands(&self, shop: &mut Building, [low, high]: [Vector2<f64>; 2], stands: &[Option<u64>; 2]) {
        let [edge, height_m] = STAND_M;
        let middle = 0.5 * (low.y + high.y);
        for (x, looks) in [low.x - 0.5 * edge, high.x + 0.5 * edge].into_iter().zip(stands) {
            let Some(looks) = looks else { continue };
            let centre = Vector2::new(x, middle);
            let half = Vector2::new(0.5, 0.5) * edge;
            for (left, right) in sides(centre - half, centre + half) {
                let mut rng = ChaCha8Rng::seed_from_u64(*looks);
                shop.put(left, right, [0.0, height_m], stand(edge, height_m, &mut rng));
            }
        }
    }

    /// A row of lamps over each aisle, and the window.
    fn lights(&self) -> Vec<LightGroup> {
        let aisles = self.aisles();
        let (length_m, n) = (self.params.length_m, (self.params.length_m / 5.0).ceil() as usize);
        let row = |(number, y): (usize, &f64)| LightGroup {
            kind: LightKind::Lamps(number),
            color: [0.42, 0.40, 0.36],
            places: (0..n)
                .map(|i| Vector2::new(length_m * ((i as f64 + 0.5) / n as f64 - 0.5), *y))
                .collect(),
            reach_m: 2.5,
        };
        let n_panes = (self.params.width_m / 3.0).ceil() as usize;
        let pane =
            |i| Vector2::new(0.5 * length_m, self.params.width_m * ((i as f64 + 0.5) / n_panes as f64 - 0.5));
        let window = LightGroup {
            kind: LightKind::Window(0),
            color: [0.30, 0.34, 0.40],
            places: (0..n_panes).map(pane).collect(),
            reach_m: 4.0,
        };
        let skylight = LightGroup {
            kind: LightKind::Skylight,
            color: [0.05, 0.055, 0.06],
            places: vec![Vector2::zeros()],
            reach_m: 1e3,
        };
        aisles.ys.iter().enumerate().map(row).chain([window, skylight]).collect()
    }

    fn aisles(&self) -> AisleGrid {
        let (xs, ys) = self.params.aisles();
        AisleGrid { xs, ys, max_lateral_offset_m: PLAY * self.params.min_aisle_width_m, turn_m: 0.8 }
    }
}

/// New goods, or, in one of three cases, goods of another section.
fn goods<R: Rng + ?Sized>(known: &mut Vec<u64>, rng: &mut R) -> u64 {
    if chance(0.33, rng) && !known.is_empty() {
        return known[below(known.len(), rng)];
    }
    let fresh = rng.next_u64();
    known.push(fresh);
    fresh
}
