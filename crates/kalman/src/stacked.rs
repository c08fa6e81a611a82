use nalgebra::{Const, DefaultAllocator, Dim, Dyn, OMatrix, OVector, RealField, allocator::Allocator};
use wayfix_estimation_traits::{Manifold, SensorModel, Tangent, TangentMatrix, UpdateAlloc};

/// Several points of one manifold side by side, as one point of their product: a batch of measurements.
#[derive(Clone, Debug, PartialEq)]
pub struct StackedMeasurement<Z>(pub Vec<Z>);

/// Several sensors of one kind with independent noise, as one sensor: the batch update.
///
/// Works in every form; the joint innovation allows a joint gate.
///
/// ```
/// use nalgebra::{Matrix1, Matrix1x2, Matrix2, Vector1, Vector2};
/// use wayfix_gaussian_core::Gaussian;
/// use wayfix_kalman::{ExtendedKalmanFilter, LinearMotion, LinearSensor, StackedMeasurement, StackedSensor};
/// let motion = LinearMotion::stationary(Matrix2::zeros())?;
/// let prior = Gaussian::new(Vector2::zeros(), Matrix2::identity())?;
/// let mut filter = ExtendedKalmanFilter::new(motion, Default::default(), prior)?;
/// let x = LinearSensor::new(Matrix1x2::new(1.0, 0.0), Matrix1::new(1.0))?;
/// let y = LinearSensor::new(Matrix1x2::new(0.0, 1.0), Matrix1::new(1.0))?;
/// let innovation = filter.update(&StackedSensor(vec![x, y]), &StackedMeasurement(vec![Vector1::new(2.0), Vector1::new(4.0)]))?;
/// assert_eq!(innovation.dim(), 2);
/// assert!((filter.estimate().mean() - Vector2::new(1.0, 2.0)).norm() < 1e-15);
/// # Ok::<(), wayfix_kalman::KalmanError>(())
/// ```
#[derive(Clone, Debug)]
pub struct StackedSensor<S>(pub Vec<S>);

impl<Z: Manifold> Manifold for StackedMeasurement<Z>
where
    DefaultAllocator: Allocator<Z::Dim>,
{
    type Scalar = Z::Scalar;
    type Dim = Dyn;

    fn dim(&self) -> Dyn {
        Dyn(self.0.iter().map(|part| part.dim().value()).sum())
    }

    fn retract(&self, delta: &OVector<Z::Scalar, Dyn>) -> Self {
        let mut start = 0;
        let parts = self.0.iter().map(|part| {
            let dim = part.dim();
            let piece = Tangent::<Z>::from_fn_generic(dim, Const::<1>, |i, _| delta[start + i]);
            start += dim.value();
            part.retract(&piece)
        });
        Self(parts.collect())
    }

    fn local(&self, other: &Self) -> OVector<Z::Scalar, Dyn> {
        let pieces = self.0.iter().zip(&other.0).map(|(from, to)| {
            // Parts of different size have no difference; a filter refuses the NaN.
            let nan = nalgebra::zero::<Z::Scalar>() / nalgebra::zero();
            if from.dim() == to.dim() {
                from.local(to)
            } else {
                Tangent::<Z>::repeat_generic(from.dim(), Const::<1>, nan)
            }
        });
        let entries: Vec<Z::Scalar> =
            pieces.flat_map(|piece| piece.iter().copied().collect::<Vec<_>>()).collect();
        OVector::<Z::Scalar, Dyn>::from_vec(entries)
    }
}

impl<S: SensorModel> SensorModel for StackedSensor<S>
where
    DefaultAllocator: UpdateAlloc<<S::State as Manifold>::Dim, <S::Measurement as Manifold>::Dim>
        + UpdateAlloc<<S::State as Manifold>::Dim, Dyn>,
{
    type State = S::State;
    type Measurement = StackedMeasurement<S::Measurement>;

    fn expected(&self, state: &S::State) -> StackedMeasurement<S::Measurement> {
        StackedMeasurement(self.0.iter().map(|sensor| sensor.expected(state)).collect())
    }

    fn jacobian(
        &self,
        state: &S::State,
    ) -> OMatrix<<S::State as Manifold>::Scalar, Dyn, <S::State as Manifold>::Dim> {
        let blocks: Vec<_> = self.0.iter().map(|sensor| sensor.jacobian(state)).collect();
        let rows = blocks.iter().map(|block| block.nrows()).sum();
        let mut stacked = OMatrix::zeros_generic(Dyn(rows), state.dim());
        let mut start = 0;
        for block in &blocks {
            copy_block(block, &mut stacked, (start, 0));
            start += block.nrows();
        }
        stacked
    }

    fn noise(&self, state: &S::State) -> TangentMatrix<StackedMeasurement<S::Measurement>> {
        let blocks: Vec<_> = self.0.iter().map(|sensor| sensor.noise(state)).collect();
        let rows = blocks.iter().map(|block| block.nrows()).sum();
        let mut diagonal = OMatrix::zeros_generic(Dyn(rows), Dyn(rows));
        let mut start = 0;
        for block in &blocks {
            copy_block(block, &mut diagonal, (start, start));
            start += block.nrows();
        }
        diagonal
    }
}

/// Puts `block` into `target` with its first entry at `corner`.
fn copy_block<T, R, C, K>(block: &OMatrix<T, R, C>, target: &mut OMatrix<T, Dyn, K>, corner: (usize, usize))
where
    T: RealField + Copy,
    R: Dim,
    C: Dim,
    K: Dim,
    DefaultAllocator: Allocator<R, C> + Allocator<Dyn, K>,
{
    for column in 0..block.ncols() {
        for row in 0..block.nrows() {
            target[(corner.0 + row, corner.1 + column)] = block[(row, column)];
        }
    }
}
