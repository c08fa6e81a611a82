use wayfix_sensor_log::LaserScan;

/// Range limit for a scan that states none, m.
const FARTHEST_ECHO: f64 = 1e5;

/// The largest range of a scan that is an echo; `range_max` itself is no echo.
pub fn max_echo_range(scan: &LaserScan) -> f64 {
    scan.range_max.next_down().min(FARTHEST_ECHO)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scan_without_a_limit_has_a_finite_one() {
        let scan = |range_max| LaserScan {
            angle_min: 0.0,
            angle_increment: 0.1,
            range_max,
            beam_period: 0.0,
            ranges: vec![1.0],
        };
        assert_eq!(max_echo_range(&scan(f64::INFINITY)), FARTHEST_ECHO);
        assert!(max_echo_range(&scan(8.0)) < 8.0);
    }
}
