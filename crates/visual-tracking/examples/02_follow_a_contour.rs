//! How well the contour tracker follows simulated targets, as it is and without one of its parts:
//! `cargo run --release -p wayfix-visual-tracking --example 02_follow_a_contour -- [FILM|all] [SEEDS]`.
//!
//! The first contour is the true one. Overlap is the intersection of contour and target over their union, 0 where the target is lost.

#[path = "../tests/integration/common/films.rs"]
mod films;

use films::{Record, follow};
use wayfix_scene_sim::film::SyntheticFilm;
use wayfix_visual_tracking::{ColorContourTrackerParams, TrackingCues};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "all".to_owned());
    let n_seeds = arguments.next().map_or(Ok(3), |n| n.parse())?;
    let films = if name == "all" { SyntheticFilm::ALL.to_vec() } else { vec![SyntheticFilm::named(&name)?] };

    let full = ColorContourTrackerParams::default();
    let methods = [
        ("full method", full),
        ("fixed colours", ColorContourTrackerParams { adapts_colors: false, ..full }),
        ("colour only", ColorContourTrackerParams { cues: TrackingCues::Color, ..full }),
        ("shape only", ColorContourTrackerParams { cues: TrackingCues::Shape, ..full }),
        ("as published", ColorContourTrackerParams::as_published()),
    ];
    println!(
        "{:10} {:14} {:>8} {:>8} {:>8} {:>8}",
        "film", "method", "overlap", "worst", "lost", "distractor"
    );
    for film in films {
        for (method, params) in methods {
            let records: Vec<Record> =
                (1..=n_seeds).map(|seed| follow(&SyntheticFilm { seed, ..film }, params)).collect();
            let mean =
                |value: fn(&Record) -> f64| records.iter().map(value).sum::<f64>() / records.len() as f64;
            let worst = records.iter().map(Record::mean_overlap).fold(1.0, f64::min);
            let (overlap, lost) = (mean(Record::mean_overlap), mean(|record| record.n_lost() as f64));
            let distractor = mean(Record::decoy_inside);
            println!("{:10} {method:14} {overlap:8.3} {worst:8.3} {lost:8.1} {distractor:8.3}", film.name);
        }
    }
    Ok(())
}
