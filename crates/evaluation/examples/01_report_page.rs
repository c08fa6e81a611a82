//! Writes a report of an invented robot into a folder: what the page looks like, and what the browser check reads.
//!
//! `cargo run -p wayfix --example 01_report_page -- target/report-page`

use std::collections::BTreeMap;
use std::path::PathBuf;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_evaluation::plot::{
    AxisScale, ConsistencyPlot, EstimatedLandmark, LinePlot, MapPlot, PlotError, PlotSeries, PoseErrorPlot,
    PoseErrorSample, StepTimesPlot,
};
use wayfix_evaluation::report::{FullReport, MachineInfo, Metric, ReportRun, ReportSuite, table};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "target/report-page".to_owned()));
    let mut suites = Vec::new();
    for (k, name) in ["slam", "consistency"].into_iter().enumerate() {
        let runs = (0..4).map(|n| invented_run(n, 10 * k as u64 + n)).collect::<Result<_, _>>()?;
        suites.push(ReportSuite { name: name.to_owned(), runs });
    }
    let commit = wayfix_evaluation::report::commit(&std::env::current_dir()?);
    let report =
        FullReport { suites, seed: 1, commit, machine: MachineInfo::detect(), ..FullReport::default() };
    report.write(&folder)?;
    print!("{}", table::report(&report, table::TableStyle::of_stdout()));
    println!("{}", folder.join("index.html").display());
    Ok(())
}

const N_STEPS: usize = 6000;

/// A lap around a hall of 12 m by 8 m with errors that a filter might have.
fn invented_run(n: u64, seed: u64) -> Result<ReportRun, PlotError> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    // Four uniform numbers give a bell that is good enough for a picture.
    let mut bell = move || (0..4).map(|_| rng.random_range(-0.87..0.87)).sum::<f64>();
    let (mut map, mut error, mut nees, mut times) =
        (MapPlot::default(), PoseErrorPlot::default(), Vec::new(), Vec::new());
    let (mut drift, mut slow) = ([0.0; 2], [0.0; 3]);
    for k in 0..N_STEPS {
        let t = k as f64 * 0.1;
        let phase = t * 0.043;
        let truth = (
            5.5 * phase.cos() + 0.6 * (7.0 * phase).cos(),
            3.4 * (phase * 1.02).sin() + 0.5 * (5.0 * phase).sin(),
        );
        let sigma = [0.03 + 0.02 * (t * 0.05).sin().abs(), 0.03, 0.012];
        for (component, sigma) in slow.iter_mut().zip(sigma) {
            *component = 0.97 * *component + 0.24 * sigma * bell();
        }
        drift = [drift[0] + 0.012 * bell() + 0.0006, drift[1] + 0.012 * bell()];
        map.truth.push(truth);
        map.estimate.push((truth.0 + slow[0], truth.1 + slow[1]));
        map.dead_reckoning.push((truth.0 + drift[0], truth.1 + drift[1]));
        error.samples.push(PoseErrorSample { t, error: slow, sigma });
        nees.push((t, slow.iter().zip(sigma).map(|(e, s)| (e / s).powi(2)).sum()));
        times.push((
            k as f64,
            9.0 + 0.0006 * k as f64 + 1.5 * bell().abs() + if k % 397 == 0 { 60.0 } else { 0.0 },
        ));
    }
    // One gap and one excursion, as real runs have them.
    error.samples[2500..2600].iter_mut().for_each(|sample| sample.error[1] = f64::NAN);
    error.samples[4000].error[0] = 0.31;
    for k in 0..15 {
        let place = (f64::from(k * 37 % 120) * 0.1 - 6.0, f64::from(k * 53 % 90) * 0.1 - 4.5);
        let (xx, yy) = (0.004 + 0.01 * bell().abs(), 0.003 + 0.03 * bell().abs());
        let covariance = [[xx, 0.5 * (xx * yy).sqrt()], [0.5 * (xx * yy).sqrt(), yy]];
        map.true_landmarks.push(place);
        map.landmarks.push(EstimatedLandmark {
            position: (place.0 + 0.06 * bell(), place.1 + 0.06 * bell()),
            covariance,
        });
    }
    let growth = |power: i32| (1..=200).map(|n| (f64::from(n), f64::from(n).powi(power))).collect();
    let nees_mean = nees.iter().map(|(_, value): &(f64, f64)| value).sum::<f64>() / nees.len() as f64;
    map.title = "Map and path".to_owned();
    error.title = "Error of the pose".to_owned();
    let consistency = ConsistencyPlot {
        title: "Consistency of the pose".to_owned(),
        statistic: "NEES".to_owned(),
        samples: nees,
        expected: 3.0,
        band: (0.2158, 9.3484),
        window: 100,
        scale: if n.is_multiple_of(2) { AxisScale::Linear } else { AxisScale::Log10 },
    };
    let lines = LinePlot {
        title: "Cost of an update".to_owned(),
        x_label: "landmarks".to_owned(),
        y_label: "multiplications".to_owned(),
        series: vec![
            PlotSeries::new("dense", growth(3)),
            PlotSeries::new("sparse", growth(2)),
            PlotSeries::new("one landmark", growth(1)),
        ],
        x_scale: AxisScale::Log10,
        y_scale: AxisScale::Log10,
        band: None,
    };
    let mut figures = vec![
        map.draw()?,
        error.draw()?,
        consistency.draw()?,
        StepTimesPlot { points: times, ..StepTimesPlot::default() }.draw()?,
    ];
    if n == 3 {
        figures
            .extend([lines.draw()?, LinePlot { title: "Empty".to_owned(), ..LinePlot::default() }.draw()?]);
    }
    Ok(ReportRun {
        name: format!("invented-hall-{}", n + 1),
        metrics: vec![
            Metric::new("ate_aligned_rmse_m", 0.11 + 0.02 * n as f64, "m")
                .at_most(0.164)
                .paper(0.2)
                .peer("numpy filter", 0.157)
                .bound_from("own defaults, docs/accuracy.md"),
            Metric::new("nees_mean", nees_mean, "")
                .at_least(2.0)
                .at_most(4.0)
                .bound_from("chi-squared, 3 degrees of freedom"),
            Metric::new("n_landmarks", 15.0, "").at_least(15.0).at_most(15.0).bound_from("the scene has 15"),
            Metric::new("heading_rmse_deg", if n == 2 { f64::NAN } else { 0.69 }, "°"),
        ],
        seconds: 0.8 + 31.0 * n as f64,
        timings: vec![
            Metric::new("step_mean_us", 12.7 + n as f64, "µs"),
            Metric::new("step_max_us", 71.3, "µs"),
        ],
        events: BTreeMap::from([("new landmark".to_owned(), 15), ("rejected".to_owned(), 12 + n)]),
        figures,
        notes: vec!["Every number of this page is invented; the example shows the layout.".to_owned()],
        warnings: Vec::new(),
        log: Some(format!("slam/invented-hall-{}.mcap", n + 1)),
        layout: None,
        error: None,
    })
}
