use nalgebra::DefaultAllocator;

use super::{
    LawViolation,
    check::{distance, extent, rounding, within},
    jacobian::agrees,
    tangents::{LENGTHS, tangents},
};
use crate::{LieGroup, StateAlloc, Tangent, to_f64};

/// The laws of [`LieGroup`], for all triples of `points` and tangents of both signs up to almost half a turn.
///
/// ```
/// use wayfix_estimation_traits::{Pose2, laws};
/// laws::lie_group(&[Pose2::new(0.0, 0.0, 0.0), Pose2::new(1.0, -2.0, 3.1), Pose2::new(50.0, 3.0, -3.1)])?;
/// # Ok::<(), laws::LawViolation>(())
/// ```
///
/// # Errors
/// The first law that does not hold.
pub fn lie_group<G: LieGroup>(points: &[G]) -> Result<(), LawViolation>
where
    DefaultAllocator: StateAlloc<G::Dim>,
{
    // Products of three points are three times as far out; so are distances seen from there.
    let size = 3.0 * extent(points);
    let tolerance = rounding::<G::Scalar>(size);
    group(points, tolerance)?;
    let steps = tangents(&G::identity(), &LENGTHS);
    for xi in &steps {
        exponential::<G>(xi, rounding::<G::Scalar>(10.0))?;
    }
    for (index, g) in points.iter().enumerate() {
        within("exp log g = g (law 3)", distance(g, &G::exp(&g.log())), tolerance, || {
            format!("point {index}")
        })?;
        for xi in &steps {
            let conjugated = g.compose(&G::exp(xi)).compose(&g.inverse());
            let error = distance(&conjugated, &G::exp(&(g.adjoint() * xi)));
            within("g exp(ξ) g⁻¹ = exp(Ad ξ) (law 4)", error, tolerance * 3.0, || {
                format!("point {index}, tangent {:?}", xi.as_slice())
            })?;
        }
    }
    Ok(())
}

fn group<G: LieGroup>(points: &[G], tolerance: f64) -> Result<(), LawViolation>
where
    DefaultAllocator: StateAlloc<G::Dim>,
{
    let identity = G::identity();
    for (i, g) in points.iter().enumerate() {
        let case = || format!("point {i}");
        within("g e = g (law 1)", distance(g, &g.compose(&identity)), tolerance, case)?;
        within("e g = g (law 1)", distance(g, &identity.compose(g)), tolerance, case)?;
        within("g g⁻¹ = e (law 1)", distance(&identity, &g.compose(&g.inverse())), tolerance, case)?;
        within("g⁻¹ g = e (law 1)", distance(&identity, &g.inverse().compose(g)), tolerance, case)?;
        for (j, h) in points.iter().enumerate() {
            for (k, l) in points.iter().enumerate() {
                let (left, right) = (g.compose(&h.compose(l)), g.compose(h).compose(l));
                let case = || format!("points {i}, {j}, {k}");
                within("g (h k) = (g h) k (law 1)", distance(&left, &right), tolerance, case)?;
            }
        }
    }
    Ok(())
}

fn exponential<G: LieGroup>(xi: &Tangent<G>, tolerance: f64) -> Result<(), LawViolation>
where
    DefaultAllocator: StateAlloc<G::Dim>,
{
    let case = || format!("tangent {:?}", xi.as_slice());
    let whole = G::exp(xi);
    within("log exp ξ = ξ (law 3)", to_f64((whole.log() - xi).norm()), tolerance, case)?;
    let scaled = |factor: f64| G::exp(&(xi * nalgebra::convert::<f64, G::Scalar>(factor)));
    for (s, t) in [(0.5, 0.5), (1.0, -1.0), (-1.0, -0.5), (0.25, -2.0), (-0.75, 1.5)] {
        let error = distance(&scaled(s).compose(&scaled(t)), &scaled(s + t));
        within("exp(sξ) exp(tξ) = exp((s+t)ξ) (law 2)", error, tolerance, || {
            format!("s = {s}, t = {t}, tangent {:?}", xi.as_slice())
        })?;
    }
    let law = "log_jacobian is the derivative of log(g exp δ) (law 6)";
    agrees(law, &whole.log_jacobian(), G::log, &whole, 10.0, case)?;
    let length = to_f64(xi.norm());
    if length < 0.1 {
        // A first-order error is as long as ξ; the second-order one stays below ten times its square.
        let error = distance(&G::identity().retract(xi), &whole);
        let second_order = 10.0 * length * length + tolerance;
        within("e ⊞ ξ = exp(ξ) + O(ξ²) (law 5)", error, second_order, case)?;
    }
    Ok(())
}
