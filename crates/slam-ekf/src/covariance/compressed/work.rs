//! Multiply-adds of the two operations to be compared.

/// One correction of `n` states by `m` rows.
pub(super) fn correction(n: usize, m: usize) -> f64 {
    let (n, m) = (n as f64, m as f64);
    0.5 * n * m * (n + m)
}

/// Propagating the information of an area of `area` states to the rest of a map of `n`, and choosing another.
pub(super) fn global_update(n: usize, area: usize, n_influences: usize) -> f64 {
    let (outside, area, v) = ((n - area) as f64, area as f64, n_influences as f64);
    let copies = COPY * n as f64 * area;
    0.5 * outside * outside * v + outside * v * (area + v) + 0.5 * outside * area * area + copies
}

/// Multiply-adds that take as long as to move one number across a matrix.
const COPY: f64 = 10.0;
