use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix::cml::experiments::*;
use wayfix_appearance_cml::*;
use wayfix_scene_sim::{indoors::*, random::Streams};
fn main() {
    for (name, which) in [("store", 0), ("area", 1), ("lab", 2)] {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let b = match which {
            0 => Store::draw(StoreParams::home_store(), &mut rng).unwrap().building(),
            1 => Store::draw(StoreParams::area(), &mut rng).unwrap().building(),
            _ => Lab::draw(&mut rng).building(),
        };
        let r = b.aisles().tour(if which == 0 { 1200.0 } else { 300.0 }, &mut rng).unwrap();
        let t = Trip::drive(&b, r, IndoorParams::default(), Streams::new(rng)).unwrap();
        let bins = [0.02, 0.1, 0.3, 0.6, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0, 100.0];
        let mut v: Vec<Vec<f64>> = vec![vec![]; bins.len()];
        let mut rot: Vec<Vec<f64>> = vec![vec![]; bins.len()];
        let n = t.steps.len();
        for i in (0..n).step_by(7) {
            for j in (0..n).step_by(3) {
                if i == j {
                    continue;
                }
                let d = (t.steps[i].pose.translation - t.steps[j].pose.translation).norm();
                let k = bins.iter().position(|b| d < *b).unwrap();
                if k > 7 && (i * 31 + j) % 17 != 0 {
                    continue;
                }
                if let (Some(a), Some(b)) = (&t.steps[i].view, &t.steps[j].view) {
                    let c = a.compare(b);
                    v[k].push(c.distance);
                    let e = wayfix_estimation_traits::wrap_angle(
                        c.rotation - (t.steps[i].pose.heading() - t.steps[j].pose.heading()),
                    );
                    rot[k].push(e.abs());
                }
            }
        }
        let refused = t.steps.iter().filter(|s| s.view.is_none()).count();
        println!("{name} {n} refused {refused}");
        for k in 0..bins.len() {
            let x = &mut v[k];
            let y = &mut rot[k];
            if x.is_empty() {
                continue;
            }
            x.sort_by(f64::total_cmp);
            y.sort_by(f64::total_cmp);
            let q = |s: f64| x[((x.len() - 1) as f64 * s) as usize];
            let r = |s: f64| y[((y.len() - 1) as f64 * s) as usize];
            println!(
                "<{:6} n{:7} min {:.3} 1% {:.3} 10% {:.3} med {:.3} 90% {:.3}  rot med {:.1}° 90% {:.1}°",
                bins[k],
                x.len(),
                x[0],
                q(0.01),
                q(0.1),
                q(0.5),
                q(0.9),
                r(0.5).to_degrees(),
                r(0.9).to_degrees()
            );
        }
    }
}
