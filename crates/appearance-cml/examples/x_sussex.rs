use wayfix_appearance_cml::*;
fn main() {
    let rgb = std::fs::read("/tmp/s6/v_sussex.rgb").unwrap();
    let xy: Vec<f64> = std::fs::read("/tmp/s6/v_sussex.xy").unwrap().chunks(8).map(|c| f64::from_le_bytes(c.try_into().unwrap())).collect();
    let f = PanoramaFeatures::new(PanoramaParams{sense:TurnSense::Counterclockwise,..Default::default()}, 120, 25).unwrap();
    let t = std::time::Instant::now();
    let d: Vec<_> = rgb.chunks(9000).map(|c| f.describe(&Panorama::from_rgb(120, 25, c.to_vec()).unwrap()).unwrap()).collect();
    println!("describe {:?}", t.elapsed() / d.len() as u32);
    let t = std::time::Instant::now();
    let (mut sum, mut n, mut max, mut c) = (0.0, 0, 0.0f64, 0);
    let mut dist = vec![];
    for q in (4..d.len()).step_by(5) {
        let mut best = (9.0, 0);
        for r in (0..d.len()).filter(|r| r % 5 != 4) { let k = d[q].compare(&d[r]); c += 1; if k.distance < best.0 { best = (k.distance, r) } }
        let e = (xy[2*q]-xy[2*best.1]).hypot(xy[2*q+1]-xy[2*best.1+1]);
        dist.push(best.0); sum += e; n += 1; max = max.max(e);
    }
    dist.sort_by(f64::total_cmp);
    println!("mean {} max {max} nn median {} p95 {} compare {:?}", sum / n as f64, dist[n/2], dist[n*95/100], t.elapsed() / c);
}
