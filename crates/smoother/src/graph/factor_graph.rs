use super::{
    batch::{AnyBatch, Batch},
    dense_quadratic::DenseQuadratic,
    known_minimum::KnownMinimum,
    structure::Structure,
    values::Values,
};
use crate::{
    Ids, Information, Kernel, Marginals, Params, Residual, SmootherError, Summary, Variable, VariableId,
    VariableTuple, information, marginals, optimize,
};

/// Variables with their values, and residuals between them: the cost is $`\sum ρ(r^T Ω r)`$.
///
/// ```
/// use nalgebra::Matrix3;
/// use wayfix_estimation_traits::{LieGroup, Pose2};
/// use wayfix_smoother::{Between, Graph, Params};
///
/// let mut graph = Graph::new();
/// let first = graph.add_variable(Pose2::identity());
/// let second = graph.add_variable(Pose2::new(0.7, 0.2, 0.1));
/// graph.fix(first)?;
/// graph.add(Between::new(Pose2::new(1.0, 0.0, 0.0)), (first, second), Matrix3::identity())?;
/// let summary = graph.optimize(&Params::default())?;
/// assert!(summary.cost < 1e-12 && (graph.value(second)?.x() - 1.0).abs() < 1e-6);
/// # Ok::<(), wayfix_smoother::SmootherError>(())
/// ```
#[derive(Default)]
pub struct Graph {
    pub(crate) values: Values,
    pub(crate) fixed: Vec<bool>,
    pub(crate) dims: Vec<usize>,
    pub(crate) batches: Vec<Box<dyn AnyBatch>>,
    /// Number of the next residual.
    pub(super) next_residual: usize,
    /// Ordering and symbolic factorization, kept until the graph changes.
    pub(crate) structure: Option<Structure>,
    /// Set while the values are known to be a minimum.
    pub(crate) minimum: Option<KnownMinimum>,
}

/// A residual of a [`Graph`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ResidualId {
    batch: usize,
    index: usize,
}

impl ResidualId {
    /// Number of the residual in the order of adding, from 0: errors use it.
    pub fn index(self) -> usize {
        self.index
    }
}

impl Graph {
    /// A graph without variables.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a variable with its first value.
    pub fn add_variable<X: Variable>(&mut self, value: X) -> VariableId<X> {
        self.structure = None;
        let dim = value.tangent_dim();
        let id = self.values.push(value);
        if id.index == self.dims.len() {
            self.fixed.push(false);
            self.dims.push(dim);
        } else {
            (self.fixed[id.index], self.dims[id.index]) = (false, dim);
        }
        self.minimum = self.minimum.take().map(|minimum| minimum.with_variable(id.index));
        id
    }

    /// The present value of a variable.
    ///
    /// # Errors
    /// [`SmootherError::UnknownId`]
    pub fn value<X: Variable>(&self, id: VariableId<X>) -> Result<&X, SmootherError> {
        self.values.get(id).ok_or(SmootherError::UnknownId)
    }

    /// Replaces the value of a variable.
    ///
    /// # Errors
    /// [`SmootherError::UnknownId`], or [`SmootherError::Shape`] for a value of another dimension.
    pub fn set_value<X: Variable>(&mut self, id: VariableId<X>, value: X) -> Result<(), SmootherError> {
        let place = self.values.get_mut(id).ok_or(SmootherError::UnknownId)?;
        let (expected, got) = ((place.tangent_dim(), 1), (value.tangent_dim(), 1));
        if expected != got {
            return Err(SmootherError::Shape { what: "the variable", residual: id.index, expected, got });
        }
        *place = value;
        self.minimum = None;
        Ok(())
    }

    /// Holds a variable at its value.
    ///
    /// # Errors
    /// [`SmootherError::UnknownId`]
    pub fn fix<X: Variable>(&mut self, id: VariableId<X>) -> Result<(), SmootherError> {
        self.value(id)?;
        self.forget();
        self.fixed[id.index] = true;
        Ok(())
    }

    /// Adds a residual between variables, with the inverse of its covariance.
    ///
    /// Information may be singular: directions without information cost nothing.
    ///
    /// # Errors
    /// * [`SmootherError::UnknownId`], [`SmootherError::SelfConnection`] for a variable twice.
    /// * [`SmootherError::Shape`], [`SmootherError::NotFinite`] for what the residual returns at the present values.
    /// * [`SmootherError::AsymmetricInformation`], [`SmootherError::IndefiniteInformation`].
    pub fn add<R: Residual>(
        &mut self,
        residual: R,
        variables: Ids<R>,
        information: Information<R>,
    ) -> Result<ResidualId, SmootherError> {
        let keys = R::Variables::keys(&self.values, variables).ok_or(SmootherError::UnknownId)?;
        let named = &keys.indices[..R::Variables::ARITY];
        let repeated = named.iter().enumerate().find(|(place, index)| named[..*place].contains(index));
        if let Some((_, variable)) = repeated {
            return Err(SmootherError::SelfConnection { variable: *variable });
        }
        let index = self.next_residual;
        information::check(&R::Variables::information_matrix(&information), index)?;
        let mut single = Batch::<R>::default();
        single.push(residual, keys, information, index);
        single.check(&self.values)?;
        self.minimum = self.minimum.take().and_then(|minimum| self.minimum_with_residual(minimum, &single));

        let found = self.batches.iter_mut().position(|batch| batch.as_any_mut().is::<Batch<R>>());
        let batch = found.unwrap_or_else(|| {
            self.batches.push(Box::new(Batch::<R>::default()));
            self.batches.len() - 1
        });
        if let Some(typed) = self.batches[batch].as_any_mut().downcast_mut::<Batch<R>>() {
            typed.append(single);
        }
        self.next_residual += 1;
        self.structure = None;
        Ok(ResidualId { batch, index })
    }

    /// Replaces the information of a residual of type `R`; the structure is kept.
    ///
    /// # Errors
    /// [`SmootherError::UnknownId`] if the residual is not of this type; else as [`add`](Self::add).
    pub fn set_information<R: Residual>(
        &mut self,
        id: ResidualId,
        information: Information<R>,
    ) -> Result<(), SmootherError> {
        information::check(&R::Variables::information_matrix(&information), id.index)?;
        let batch =
            self.batches.get_mut(id.batch).and_then(|batch| batch.as_any_mut().downcast_mut::<Batch<R>>());
        batch.ok_or(SmootherError::UnknownId)?.set_information(id.index, information)?;
        self.minimum = None;
        Ok(())
    }

    /// Gives a residual a robust kernel.
    ///
    /// # Errors
    /// [`SmootherError::UnknownId`], [`SmootherError::OutOfRange`] for a parameter that is not positive.
    pub fn set_kernel(&mut self, id: ResidualId, kernel: Kernel) -> Result<(), SmootherError> {
        kernel.validate()?;
        let batch = self.batches.get_mut(id.batch).ok_or(SmootherError::UnknownId)?;
        if !batch.set_kernel(id.index, kernel) {
            return Err(SmootherError::UnknownId);
        }
        self.minimum = None;
        Ok(())
    }

    /// Takes a residual back.
    ///
    /// # Errors
    /// [`SmootherError::UnknownId`] when it is not there (any more).
    pub fn remove(&mut self, id: ResidualId) -> Result<(), SmootherError> {
        let batch = self.batches.get_mut(id.batch).ok_or(SmootherError::UnknownId)?;
        if !batch.remove(id.index) {
            return Err(SmootherError::UnknownId);
        }
        self.forget();
        Ok(())
    }

    /// Number of variables, fixed ones included.
    pub fn n_variables(&self) -> usize {
        self.values.n_present()
    }

    /// Number of residuals.
    pub fn n_residuals(&self) -> usize {
        self.batches.iter().map(|batch| batch.len()).sum()
    }

    /// Whether a variable, by its number, is neither held nor named by any residual.
    pub fn is_without_residual(&self, variable: usize) -> bool {
        let mut named = self.batches.iter().flat_map(|batch| batch.variables()).flatten();
        self.fixed.get(variable) == Some(&false) && !named.any(|index| *index == variable)
    }

    /// The residuals of a type in the order of adding, with the numbers of their variables and their information.
    pub fn residuals<R: Residual>(
        &self,
    ) -> impl Iterator<Item = (ResidualId, &R, &[usize], &Information<R>)> {
        self.batches.iter().enumerate().flat_map(|(batch, residuals)| {
            let typed = residuals.as_any().downcast_ref::<Batch<R>>().into_iter();
            typed.flat_map(Batch::entries).map(move |(index, residual, named, information)| {
                (ResidualId { batch, index }, residual, named, information)
            })
        })
    }

    /// $`\sum ρ(r^T Ω r)`$ at the present values.
    pub fn cost(&self) -> f64 {
        self.cost_at(&self.values, 1.0)
    }

    /// $`r^T Ω r`$ of each residual at the present values, without kernels: χ² distributed where the model is right.
    ///
    /// In the order of adding; what a marginalization leaves counts as one residual.
    pub fn squared_norms(&self) -> Vec<f64> {
        let mut norms = Vec::with_capacity(self.n_residuals());
        for batch in &self.batches {
            batch.squared_norms(&self.values, &mut norms);
        }
        norms.sort_unstable_by_key(|(index, _)| *index);
        norms.into_iter().map(|(_, norm)| norm).collect()
    }

    /// Moves all variables that are not fixed to a minimum of the cost.
    ///
    /// Takes no iteration if an earlier call converged with these or stricter parameters, and only variables and residuals ([`add`](Self::add)) that are zero
    /// at the values were added since. [`Params::graduated`] always iterates.
    ///
    /// # Errors
    /// * [`SmootherError::WithoutResidual`], [`SmootherError::Unconstrained`] with the names of what is not determined.
    /// * [`SmootherError::NotFinite`], [`SmootherError::IllConditioned`], [`SmootherError::Diverged`], [`SmootherError::OutOfMemory`].
    /// * [`SmootherError::OutOfRange`] for parameters.
    ///
    /// The values stay as they were.
    pub fn optimize(&mut self, params: &Params) -> Result<Summary, SmootherError> {
        optimize::run(self, params)
    }

    /// Covariances at the present values, which should be a minimum.
    ///
    /// # Errors
    /// As [`optimize`](Self::optimize).
    pub fn marginals(&mut self) -> Result<Marginals<'_>, SmootherError> {
        marginals::at_present(self)
    }

    /// The graph is another one: nothing that was computed of it holds.
    pub(super) fn forget(&mut self) {
        (self.structure, self.minimum) = (None, None);
    }

    /// The minimum once a residual is added; `None` if it moves, or if the residual leaves a new variable free.
    fn minimum_with_residual(&self, minimum: KnownMinimum, single: &impl AnyBatch) -> Option<KnownMinimum> {
        let mut minimum = minimum.with_cost(single.cost(&self.values, 1.0))?;
        let named: Vec<usize> = single.variables().flatten().copied().collect();
        let new = minimum.take_without_residual(&named);
        if !new.is_empty() {
            let mut is_new = vec![false; self.dims.len()];
            new.iter().for_each(|index| is_new[*index] = true);
            let mut quadratic = DenseQuadratic::zeros(&new, &self.dims);
            single.linearize_chosen(&self.values, &is_new, &mut quadratic);
            quadratic.is_definite().then_some(())?;
        }
        Some(minimum)
    }

    pub(crate) fn cost_at(&self, values: &Values, mu: f64) -> f64 {
        self.batches.iter().map(|batch| batch.cost(values, mu)).sum()
    }

    /// The residual that is not finite, as an error.
    pub(crate) fn locate_not_finite(&self, values: &Values) -> SmootherError {
        let found = self.batches.iter().find_map(|batch| batch.check(values).err());
        found.unwrap_or(SmootherError::NotFinite { what: "the sum of squares", residual: None })
    }
}
