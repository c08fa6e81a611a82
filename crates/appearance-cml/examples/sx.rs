use nalgebra::Vector3;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use std::sync::Arc;
use wayfix_appearance_cml::*;
use wayfix_estimation_traits::{LieGroup, Pose2, wrap_angle};
use wayfix_gaussian_core::Gaussian;
#[derive(Clone, Debug)]
struct V(usize, Arc<(usize, Vec<f64>)>);
impl Descriptor for V {
    fn compare(&self, r: &Self) -> Comparison {
        let n = self.1.0;
        Comparison {
            distance: self.1.1[self.0 * n + r.0],
            rotation: wrap_angle(self.1.1[n * n + self.0 * n + r.0]),
        }
    }
}
fn main() {
    let raw = std::fs::read("/tmp/s6/model/sx.bin").unwrap();
    let f: Vec<f64> = raw.chunks(8).map(|c| f64::from_le_bytes(c.try_into().unwrap())).collect();
    let n = f[0] as usize;
    let data = Arc::new((n, f[1..1 + 2 * n * n].to_vec()));
    let poses: Vec<Pose2<f64>> = f[1 + 2 * n * n..].chunks(3).map(|c| Pose2::new(c[0], c[1], c[2])).collect();
    let noise: f64 = std::env::args().nth(1).map_or(0.05, |s| s.parse().unwrap());
    for (name, params) in [("default", LocalizerParams::default()), ("printed", LocalizerParams::printed())] {
        for learning in [Learning::Static, Learning::Adapting] {
            let mut all = vec![];
            for seed in 0..5u64 {
                let mut rng = ChaCha8Rng::seed_from_u64(seed);
                let g = |p: Pose2<f64>| Gaussian::from_sigmas(p, &Vector3::new(0.01, 0.01, 0.03)).unwrap();
                let mut params = LocalizerParams { learning, ..params };
                if let Ok(s) = std::env::var("ODO") {
                    let s: f64 = s.parse().unwrap();
                    params.odometry.forward *= s;
                    params.odometry.sideways *= s;
                    params.odometry.heading_per_metre *= s;
                    params.odometry.heading_per_radian *= s;
                }
                let mut l: AppearanceLocalizer<V> =
                    AppearanceLocalizer::new(params, Start::Known(g(poses[0]))).unwrap();
                for k in 0..n {
                    if k % 5 != 4 {
                        l.teach(V(k, data.clone()), &g(poses[k])).unwrap();
                    }
                }
                if seed == 0 {
                    let s = l.map().scale();
                    println!(
                        "step {} E {} limit {} m(limit) {} m(E) {}",
                        s.step(),
                        s.step_distance(),
                        s.match_limit(0.8),
                        s.metres(s.match_limit(0.8)),
                        s.metres(s.step_distance())
                    );
                }
                let mut last = 0;
                for k in 0..n {
                    if k % 5 != 4 {
                        continue;
                    }
                    for j in last..k {
                        let s = poses[j].inverse().compose(&poses[j + 1]);
                        let w = s.translation.norm();
                        let mut nn = || {
                            let v: f64 = StandardNormal.sample(&mut rng);
                            v
                        };
                        let o = Pose2::new(
                            s.x() + noise * w.sqrt() * nn(),
                            s.y() + 0.5 * noise * w.sqrt() * nn(),
                            s.heading() + 0.02 * w.sqrt() * nn() + 0.05 * s.heading() * nn(),
                        );
                        l.predict(&o).unwrap();
                    }
                    last = k;
                    l.update(V(k, data.clone())).unwrap();
                    let e = l.estimate().unwrap();
                    let err = (e.mean().translation - poses[k].translation).norm();
                    if seed == 0 && std::env::args().nth(2).is_some() {
                        println!(
                            "{k} err {:.3} sig {:.3} {:.3} th {:.3} {:.3}",
                            err,
                            e.sigmas().x,
                            e.sigmas().y,
                            wrap_angle(e.mean().heading() - poses[k].heading()),
                            e.sigmas().z
                        );
                    }
                    all.push(err);
                }
            }
            let mean = all.iter().sum::<f64>() / all.len() as f64;
            let max = all.iter().copied().fold(0.0, f64::max);
            println!("{name} {learning:?} mean {:.2} cm max {:.2} cm", mean * 100.0, max * 100.0);
        }
    }
}
