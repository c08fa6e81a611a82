use rand::Rng;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

use super::super::canvas::Canvas;
use super::super::color::{Rgb8, about, from_hsv, grey, shaded};
use super::super::texture::Texture;
use crate::random::deviate::{below, chance, uniform};

/// A stretch of shelf front that is filled or cleared as one, metres.
pub(in crate::indoors) const SECTION_M: f64 = 1.0;
/// From board to board, metres.
const BOARD_SPACING_M: f64 = 0.4;
/// The lowest board, metres.
const FIRST_BOARD_M: f64 = 0.1;
/// Kinds of goods per department: few, so that shelves look alike.
const N_PRODUCTS: usize = 24;

/// Content of one section of a shelf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::indoors) struct Section {
    /// Whose goods.
    pub(in crate::indoors) department: u8,
    /// Selects the goods and their arrangement; `None` for an empty section.
    pub(in crate::indoors) goods: Option<u64>,
}

/// A kind of goods.
#[derive(Clone, Copy)]
struct Product {
    body: Rgb8,
    label: Rgb8,
    width_m: f64,
    height_m: f64,
}

/// The assortment of every department.
pub(in crate::indoors) struct Assortment {
    departments: Vec<Vec<Product>>,
}

impl Assortment {
    /// `n_departments`, each with its own hue, around which the colours of its goods vary.
    pub(in crate::indoors) fn draw<R: Rng + ?Sized>(n_departments: usize, rng: &mut R) -> Self {
        let department = |_| {
            let hue = uniform(0.0, 1.0, rng);
            (0..N_PRODUCTS).map(|_| Product::draw(hue, rng)).collect()
        };
        Self { departments: (0..n_departments).map(department).collect() }
    }

    /// The front of a shelf: sections from left to right.
    pub(in crate::indoors) fn front(&self, sections: &[Section], height_m: f64) -> Texture {
        let length_m = SECTION_M * sections.len() as f64;
        let mut canvas = Canvas::new(length_m, height_m, grey(38));
        for (i, section) in sections.iter().enumerate() {
            self.fill(&mut canvas, SECTION_M * i as f64, height_m, section);
        }
        canvas.finish()
    }

    fn fill(&self, canvas: &mut Canvas, left: f64, height_m: f64, section: &Section) {
        let right = left + SECTION_M;
        if let Some(goods) = section.goods {
            let mut rng = ChaCha8Rng::seed_from_u64(goods);
            let products = &self.departments[usize::from(section.department) % self.departments.len()];
            match below(10, &mut rng) {
                0 => hooks(canvas, (left, right), height_m, products, &mut rng),
                1 => pallets(canvas, (left, right), height_m, products, &mut rng),
                _ => boards(canvas, (left, right), height_m, products, &mut rng),
            }
        }
        let mut board = FIRST_BOARD_M;
        while board < height_m {
            canvas.rectangle((left, board - 0.05), (right, board), grey(150));
            board += BOARD_SPACING_M;
        }
        canvas.rectangle((left, 0.0), (left + 0.05, height_m), grey(110));
    }
}

impl Product {
    fn draw<R: Rng + ?Sized>(hue: f64, rng: &mut R) -> Self {
        let any = uniform(0.0, 1.0, rng);
        let body = if chance(0.75, rng) { about(hue, 0.08, rng) } else { about(any, 0.0, rng) };
        let label = from_hsv(uniform(0.0, 1.0, rng), uniform(0.0, 0.8, rng), uniform(0.6, 1.0, rng));
        Self { body, label, width_m: uniform(0.1, 0.45, rng), height_m: uniform(0.15, 0.33, rng) }
    }
}

type Span = (f64, f64);

/// Boxes and tins in rows.
fn boards<R: Rng + ?Sized>(
    canvas: &mut Canvas,
    (left, right): Span,
    height_m: f64,
    products: &[Product],
    rng: &mut R,
) {
    let mut board = FIRST_BOARD_M;
    while board + 0.1 < height_m {
        let mut x = left;
        while x < right {
            let product = products[below(products.len(), rng)];
            let until = (x + uniform(0.3, 1.0, rng)).min(right);
            while x < until {
                let to = (x + product.width_m).min(right);
                put(canvas, (x, to), board, &product);
                x = to + 0.02;
            }
        }
        board += BOARD_SPACING_M;
    }
}

fn put(canvas: &mut Canvas, (left, right): Span, board: f64, product: &Product) {
    let top = board + product.height_m;
    canvas.rectangle((left, board), (right, top), product.body);
    canvas.rectangle(
        (left, board + 0.35 * product.height_m),
        (right, board + 0.65 * product.height_m),
        product.label,
    );
    canvas.rectangle((right - 0.03, board), (right, top), shaded(product.body, 0.5));
}

/// Small things on hooks.
fn hooks<R: Rng + ?Sized>(
    canvas: &mut Canvas,
    (left, right): Span,
    height_m: f64,
    products: &[Product],
    rng: &mut R,
) {
    let (a, b) = (products[below(products.len(), rng)], products[below(products.len(), rng)]);
    canvas.paint((left, 0.0), (right, height_m), |column, row| match (column % 3, row % 4) {
        (0, _) | (_, 0) => grey(90),
        _ if chance(0.5, rng) => shaded(a.body, 0.8),
        _ => b.body,
    });
}

/// One kind, piled high.
fn pallets<R: Rng + ?Sized>(
    canvas: &mut Canvas,
    (left, right): Span,
    height_m: f64,
    products: &[Product],
    rng: &mut R,
) {
    let product = products[below(products.len(), rng)];
    let top = uniform(0.5, 1.0, rng) * height_m;
    canvas.rectangle((left, 0.0), (right, top), product.body);
    canvas.rectangle((left, 0.3 * top), (right, 0.5 * top), product.label);
}
