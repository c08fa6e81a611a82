//! Parameters as a user's file has them, and segments there and back.

use approx::assert_abs_diff_eq;
use wayfix_line_extract::{
    HessianLine, LineExtraction, LineExtractionError, LineExtractionParams, Scan, SplitMethod, extract,
};

#[test]
fn a_file_names_only_what_it_changes() {
    let text =
        r#"{ "split_method": "split-and-merge", "min_points": 8, "beam_noise": { "sigma_range_m": 0.03 } }"#;
    let params: LineExtractionParams = serde_json::from_str(text).expect("valid JSON");
    assert_eq!((params.split_method, params.min_points), (SplitMethod::SplitAndMerge, 8));
    assert_eq!((params.beam_noise.sigma_range_m, params.beam_noise.sigma_bearing_rad), (0.03, 0.002));
    assert_eq!(params.merge_gate, LineExtractionParams::default().merge_gate);
    assert!(
        serde_json::from_str::<LineExtractionParams>(r#"{ "min_point": 8 }"#).is_err(),
        "a misspelt name is an error"
    );
}

#[test]
fn what_was_found_survives() -> Result<(), LineExtractionError> {
    // A wall at x = 2.
    let ranges: Vec<f64> = (0..61).map(|i| 2.0 / (-0.3 + 0.01 * f64::from(i)).cos()).collect();
    let scan = Scan { angle_min: -0.3, angle_increment: 0.01, ranges: &ranges, max_range: 8.0 };
    let seen = extract(&scan, &LineExtractionParams::default())?;
    assert!(!seen.segments.is_empty());
    let text = serde_json::to_string(&seen).expect("serializable");
    let back: LineExtraction = serde_json::from_str(&text).expect("what was written");
    assert_eq!((back.counts, back.segments.len()), (seen.counts, seen.segments.len()));
    for (a, b) in back.segments.iter().zip(&seen.segments) {
        assert_eq!((a.beams, a.n_points), (b.beams, b.n_points));
        // This reader of JSON may miss the last bit.
        assert_abs_diff_eq!(a.start, b.start, epsilon = 1e-12);
        assert_abs_diff_eq!(a.end, b.end, epsilon = 1e-12);
        assert_abs_diff_eq!(a.estimate.line.rho(), b.estimate.line.rho(), epsilon = 1e-12);
        assert_abs_diff_eq!(a.estimate.covariance, b.estimate.covariance, epsilon = 1e-15);
    }
    // A line written by hand in another of its forms is brought to the one form.
    let line: HessianLine = serde_json::from_str(r#"{ "rho": -2.0, "alpha": 0.0 }"#).expect("valid JSON");
    assert_eq!(line, HessianLine::new(-2.0, 0.0));
    assert_eq!(line.rho(), 2.0);
    Ok(())
}
