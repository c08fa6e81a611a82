//! A colour space of your own: the contour tracker follows a simulated target in YCgCo, which this crate does not know.
//! `cargo run --release -p wayfix-visual-tracking --example 04_custom_color_space`
//!
//! Luma, green and orange differences of [Malvar & Sullivan 2003], each scaled to [0, 1].

#[path = "../tests/integration/common/films.rs"]
mod films;

use films::follow;
use wayfix_scene_sim::film::SyntheticFilm;
use wayfix_visual_tracking::{ColorContourTrackerParams, ColorSpace, CustomColorSpace};

const YCGCO: CustomColorSpace = CustomColorSpace {
    axis_names: ["Y", "Cg", "Co"],
    convert: |rgb| {
        let [r, g, b] = rgb.map(|value| f64::from(value) / 255.0);
        [(r + 2.0 * g + b) / 4.0, (2.0 * g - r - b + 2.0) / 4.0, (r - b + 1.0) / 2.0]
    },
    circular_axis: None,
    scales_with_light: true,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let film = SyntheticFilm { seed: 1, ..SyntheticFilm::named("rectangle")? };
    let params = ColorContourTrackerParams { color_space: ColorSpace::Custom(YCGCO), ..Default::default() };
    let record = follow(&film, params);
    println!("{}: mean overlap {:.3}, lost in {} frames", film.name, record.mean_overlap(), record.n_lost());
    assert!(record.mean_overlap() > 0.8, "the target is not followed");
    Ok(())
}
