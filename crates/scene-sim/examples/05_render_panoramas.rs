//! Renders a strip of views for a look at them: `cargo run --example 05_render_panoramas -- store 12 > views.ppm`.

use std::error::Error;
use std::io::{Write, stdout};

use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_scene_sim::indoors::{IndoorDrive, IndoorDriveParams, Laboratory, RetailStore, RetailStoreParams};
use wayfix_scene_sim::random::RandomStreams;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let n_views: usize = arguments.get(1).map_or(Ok(12), |n| n.parse())?;
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let building = match arguments.first().map(String::as_str) {
        Some("lab") => Laboratory::draw(&mut rng).building(),
        Some("area") => RetailStore::draw(RetailStoreParams::area(), &mut rng)?.building(),
        _ => RetailStore::draw(RetailStoreParams::home_store(), &mut rng)?.building(),
    };
    let route = building.aisles().tour(n_views as f64, &mut rng)?;
    let params = IndoorDriveParams { n_people: 6, ..IndoorDriveParams::default() };
    let drive = IndoorDrive::new(&building, route, params, RandomStreams::new(rng))?;
    let views: Vec<_> = drive.step_by(4).map(|step| step.view).collect();
    let Some(first) = views.first() else { return Ok(()) };
    let mut out = stdout().lock();
    write!(out, "P6\n{} {}\n255\n", first.width, first.height * views.len())?;
    Ok(views.iter().try_for_each(|view| out.write_all(&view.rgb))?)
}
