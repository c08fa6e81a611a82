use std::sync::Arc;

use anyhow::Result;
use wayfix_color_map::ColorMap;
use wayfix_color_model::LightingFilterBank;
use wayfix_sensor_log::{Record, RecordData};

use wayfix_evaluation::{
    plot::{AxisScale, LinePlot, PlotSeries, statistics::median},
    report::{Metric, ReportRun},
};
use wayfix_systems::color::{ColorRunSetup, ColorSystemParams, run};

/// Numbers of particles, each kept fixed.
const N_PARTICLES: [usize; 5] = [100, 300, 1000, 3000, 10_000];
/// Frames of the log that are used.
const N_FRAMES: usize = 40;

/// Computing time of a frame against the number of particles. Times vary from call to call, and other runs of a report run in parallel.
///
/// # Errors
/// Returns an error if no image of the log can be used, or the picture not be drawn.
pub(crate) fn frame_time(
    records: &[Record],
    map: &Arc<ColorMap>,
    bank: &LightingFilterBank,
    params: &ColorSystemParams,
    seed: u64,
) -> Result<ReportRun> {
    let mut images = records.iter().enumerate().filter(|(_, r)| matches!(r.data, RecordData::Image(_)));
    let end = images.nth(N_FRAMES).map_or(records.len(), |(at, _)| at);
    let mut points = Vec::new();
    for n_particles in N_PARTICLES {
        let mut params = params.clone();
        params.localizer.max_particles = n_particles;
        let run = run(&records[..end], ColorRunSetup::new(map, bank, &params, seed), |_| {})?;
        let steps = run.system.frames().iter().map(|frame| 1e3 * frame.step.as_secs_f64());
        points.push((n_particles as f64, median(steps).unwrap_or(f64::NAN)));
    }
    let timings =
        points
            .iter()
            .map(|(n, ms)| Metric::new(format!("frame_time_median_ms_{n}_particles"), *ms, "ms"))
            .chain(points.iter().map(|(n, ms)| {
                Metric::new(format!("time_per_particle_us_{n}_particles"), 1e3 * ms / n, "µs")
            }))
            .collect();
    let plot = LinePlot {
        title: "Computing time of a frame".to_owned(),
        x_label: "particles".to_owned(),
        y_label: "ms".to_owned(),
        series: vec![PlotSeries::new("median of 40 frames", points)],
        x_scale: AxisScale::Log10,
        y_scale: AxisScale::Log10,
        ..LinePlot::default()
    };
    Ok(ReportRun { timings, figures: vec![plot.draw()?], ..ReportRun::default() })
}
