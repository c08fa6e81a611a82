use std::fmt;

/// A motion of the whole world that no measurement has observed.
#[derive(Clone, Debug, PartialEq)]
pub struct UnobservableDirection {
    /// Named motions with their shares, the largest first and equal to 1; per m and per rad.
    pub parts: Vec<(&'static str, f64)>,
}

impl UnobservableDirection {
    pub(super) fn new(names: &[&'static str], coefficients: impl IntoIterator<Item = f64>) -> Self {
        let mut parts: Vec<_> =
            names.iter().copied().zip(coefficients).filter(|(_, part)| part.abs() > SMALLEST).collect();
        parts.sort_by(|(_, a), (_, b)| b.abs().total_cmp(&a.abs()));
        Self { parts }
    }
}

/// A share of a motion that is too small to report.
const SMALLEST: f64 = 1e-6;

impl fmt::Display for UnobservableDirection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, (name, part)) in self.parts.iter().enumerate() {
            match index {
                0 => write!(f, "{name}")?,
                _ => write!(f, " {part:+.3} {name}")?,
            }
        }
        Ok(())
    }
}
