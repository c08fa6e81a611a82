//! tmp
use wayfix_estimation_traits::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let open = |p: &str| {
        wayfix_sensor_log::open(std::path::Path::new(p), &wayfix_sensor_log::OpenOptions::default())
            .unwrap()
            .read_all()
            .0
    };
    let recs = open(&a[1]);
    let truth = wayfix::evaluate::TrueTrack::from_records_or_estimates(&open(&a[2]));
    let params = wayfix::walls::WallSlamParams::from_toml(&std::fs::read_to_string(&a[3]).unwrap()).unwrap();
    let run = wayfix::walls::run(&recs, &params, |_| ()).unwrap();
    let k = run.system.keyframes();
    let every: usize = a[4].parse().unwrap();
    for i in (every..k.len()).step_by(every) {
        let (Some(t0), Some(t1)) = (truth.at(k[i - every].stamp), truth.at(k[i].stamp)) else { continue };
        let e = |p0: &Pose2<f64>, p1: &Pose2<f64>| {
            let d = t0.inverse().compose(&t1).inverse().compose(&p0.inverse().compose(p1));
            (d.translation.norm(), d.heading().to_degrees())
        };
        let (f, o) =
            (e(&k[i - every].pose, &k[i].pose), e(&k[i - every].dead_reckoning, &k[i].dead_reckoning));
        println!(
            "{i} filter {:.2} m {:.1} deg | odo {:.2} m {:.1} deg | nis {:.2} n {} lm {} sd {:.3} {:.3} {:.4}",
            f.0,
            f.1,
            o.0,
            o.1,
            k[i].nis.0 / (k[i].nis.1.max(1) as f64),
            k[i].nis.1,
            k[i].n_landmarks,
            k[i].covariance[(0, 0)].sqrt(),
            k[i].covariance[(1, 1)].sqrt(),
            k[i].covariance[(2, 2)].sqrt()
        );
    }
}
