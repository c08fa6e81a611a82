//! Lines in, one table out.

use std::fmt::Write as _;

/// Time of one program for one job.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Measurement {
    pub(super) job: String,
    pub(super) program: String,
    pub(super) nanoseconds: f64,
}

/// Reads `bench<TAB>job<TAB>program<TAB>nanoseconds`; other lines are none of ours.
pub(super) fn parse_line(line: &str) -> Option<Measurement> {
    let ["bench", job, program, nanoseconds] = line.split('\t').collect::<Vec<_>>()[..] else { return None };
    let nanoseconds: f64 = nanoseconds.trim().parse().ok()?;
    let sane = nanoseconds.is_finite() && nanoseconds > 0.0;
    sane.then(|| Measurement { job: job.to_owned(), program: program.to_owned(), nanoseconds })
}

/// Jobs in the order they came, fastest program first; the ratio is to the fastest program of ours.
pub(super) fn render(measurements: &[Measurement]) -> String {
    let mut jobs: Vec<&str> = Vec::new();
    for measurement in measurements {
        if !jobs.contains(&measurement.job.as_str()) {
            jobs.push(&measurement.job);
        }
    }
    let mut text = String::from("| job | program | time | ratio to ours |\n| --- | --- | ---: | ---: |\n");
    for job in jobs {
        let mut rows: Vec<_> = measurements.iter().filter(|measurement| measurement.job == job).collect();
        rows.sort_by(|a, b| a.nanoseconds.total_cmp(&b.nanoseconds));
        let ours = rows.iter().find(|row| row.program.starts_with("wayfix")).map(|row| row.nanoseconds);
        for row in rows {
            let ratio = ours.map_or("–".to_owned(), |ours| format!("{:.2}", row.nanoseconds / ours));
            let _ = writeln!(text, "| {job} | {} | {} | {ratio} |", row.program, readable(row.nanoseconds));
        }
    }
    text
}

fn readable(nanoseconds: f64) -> String {
    match nanoseconds {
        n if n < 1e3 => format!("{n:.1} ns"),
        n if n < 1e6 => format!("{:.2} µs", n / 1e3),
        n if n < 1e9 => format!("{:.2} ms", n / 1e6),
        n => format!("{:.2} s", n / 1e9),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_whole_bench_lines_count() {
        let measurement = parse_line("bench\tkalman_4x2\tkfilter\t71.5").expect("a bench line");
        assert_eq!((measurement.job.as_str(), measurement.nanoseconds), ("kalman_4x2", 71.5));
        for line in
            ["bench kalman 1", "bench\ta\tb", "bench\ta\tb\tfast", "bench\ta\tb\t-1", "bench\ta\tb\tNaN"]
        {
            assert_eq!(parse_line(line), None, "{line}");
        }
    }

    #[test]
    fn ratios_are_to_the_fastest_of_ours_and_absent_without_one() {
        let lines = [
            "bench\tj\tkfilter\t140",
            "bench\tj\twayfix Joseph\t100",
            "bench\tj\twayfix plain\t70",
            "bench\tk\tnumpy\t2000000",
        ];
        let text = render(&lines.iter().filter_map(|line| parse_line(line)).collect::<Vec<_>>());
        let rows: Vec<_> = text.lines().skip(2).collect();
        assert_eq!(
            rows,
            [
                "| j | wayfix plain | 70.0 ns | 1.00 |",
                "| j | wayfix Joseph | 100.0 ns | 1.43 |",
                "| j | kfilter | 140.0 ns | 2.00 |",
                "| k | numpy | 2.00 ms | – |",
            ]
        );
    }
}
