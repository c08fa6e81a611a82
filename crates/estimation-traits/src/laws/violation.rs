/// A law that does not hold, and by how much.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{law} fails {case}: off by {error:e}, tolerance {tolerance:e}")]
pub struct LawViolation {
    /// The law, as its trait states it.
    pub law: &'static str,
    /// Where: the point, tangent, or step that shows it.
    pub case: String,
    /// How far off.
    pub error: f64,
    /// How far off it may be.
    pub tolerance: f64,
}
