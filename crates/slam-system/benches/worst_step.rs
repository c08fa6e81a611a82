//! The worst step of EKF-SLAM on a recording: `cargo bench -p wayfix --bench worst_step`, with `WAYFIX_DATA` naming the folder of recordings.
//!
//! Every step counts with the best of several runs, which do the same work, so that what interrupts the machine does not count.

use std::path::PathBuf;

use anyhow::Result;
use wayfix_sensor_log::LogOpenOptions;
use wayfix_slam_system::{
    points::{self, PointSlamParams, RobotProfile},
    slam::AssociationRule,
};

const N_RUNS: usize = 6;

fn main() -> Result<()> {
    let folder = PathBuf::from(std::env::var_os("WAYFIX_DATA").unwrap_or_default()).join("victoria_park");
    if !folder.is_dir() {
        eprintln!("skipped: WAYFIX_DATA names no folder with victoria_park in it");
        return Ok(());
    }
    let (records, _) = wayfix_sensor_log::open(&folder, &LogOpenOptions::default())?.read_all();
    for (association, name) in [(AssociationRule::Nn, "nn"), (AssociationRule::Jcbb, "jcbb")] {
        let params = PointSlamParams {
            association: Some(association),
            ..PointSlamParams::of(RobotProfile::VictoriaPark)
        };
        let mut best: Vec<f64> = Vec::new();
        for _ in 0..N_RUNS {
            let run = points::run(&records, &params, |_| {})?;
            let steps = run
                .system
                .stamped_estimates()
                .iter()
                .map(|stamped_estimate| 1e6 * stamped_estimate.step.as_secs_f64());
            if best.is_empty() {
                best = steps.collect();
            } else {
                best.iter_mut().zip(steps).for_each(|(best, step)| *best = best.min(step));
            }
        }
        best.sort_by(f64::total_cmp);
        let mean = best.iter().sum::<f64>() / best.len() as f64;
        let share = |share: f64| best[(share * (best.len() - 1) as f64) as usize];
        println!("bench\tvictoria_park step/{name}\twayfix\t{:.0}", 1e3 * mean);
        eprintln!(
            "{name}: mean {mean:.0}, median {:.0}, 99.9 % {:.0}, worst {:.0} µs",
            share(0.5),
            share(0.999),
            share(1.0)
        );
    }
    Ok(())
}
