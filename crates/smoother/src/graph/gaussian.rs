use nalgebra::{DMatrix, DVector};

use super::{
    factor_graph::Graph,
    linear_prior::{LinearPrior, LinearPriors},
};
use crate::{SmootherError, information, marginals};

impl Graph {
    /// Adds what is known of several variables together: a Gaussian about their present values, by its information in their tangent spaces.
    ///
    /// The variables are given by their numbers ([`VariableId::index`](crate::VariableId::index)); the rows of the information are their tangent coordinates in this order.
    /// [`gaussian`](Self::gaussian) is the inverse.
    ///
    /// # Errors
    /// As [`add`](Self::add).
    pub fn add_gaussian(
        &mut self,
        variables: &[usize],
        information: DMatrix<f64>,
    ) -> Result<(), SmootherError> {
        let residual = self.next_residual;
        if !variables.iter().all(|variable| self.values.is_present(*variable)) {
            return Err(SmootherError::UnknownId);
        }
        let repeated =
            variables.iter().enumerate().find(|(place, index)| variables[..*place].contains(index));
        if let Some((_, variable)) = repeated {
            return Err(SmootherError::SelfConnection { variable: *variable });
        }
        let n = variables.iter().map(|variable| self.dims[*variable]).sum();
        if information.shape() != (n, n) {
            let (what, expected, got) = ("the information", (n, n), information.shape());
            return Err(SmootherError::Shape { what, residual, expected, got });
        }
        information::check(&information, residual)?;
        let points = variables.iter().map(|variable| self.values.linear_point(*variable)).collect();
        let (hessian, gradient) = (information.symmetric_part(), DVector::zeros(n));
        self.add_prior(LinearPrior {
            variables: variables.to_vec(),
            points,
            hessian,
            gradient,
            constant: 0.0,
        });
        Ok(())
    }

    /// All residuals together as a Gaussian of some variables, given by their numbers: mean and covariance in the tangent spaces at the present values.
    ///
    /// The others are marginalized as by [`marginalize`](Self::marginalize), but the graph stays as it is. At a minimum the mean is zero; elsewhere it is
    /// the Gauss–Newton step. Rows of fixed variables are zero.
    ///
    /// ```
    /// use nalgebra::{DMatrix, Matrix1, Vector1};
    /// use wayfix_smoother::Graph;
    /// # use wayfix_smoother::Residual;
    /// # struct Step(f64);
    /// # impl Residual for Step {
    /// #     type Dim = nalgebra::Const<1>;
    /// #     type Variables = (Vector1<f64>, Vector1<f64>);
    /// #     fn value(&self, (a, b): (&Vector1<f64>, &Vector1<f64>)) -> Vector1<f64> { b - a - Vector1::new(self.0) }
    /// # }
    /// let mut graph = Graph::new();
    /// let [a, b] = [0.0, 0.9].map(|x| graph.add_variable(Vector1::new(x)));
    /// graph.add_gaussian(&[a.index()], DMatrix::from_element(1, 1, 4.0))?; // a is 0 ± 0.5
    /// graph.add(Step(1.0), (a, b), Matrix1::new(4.0))?; // the residual b - a - 1
    /// let (mean, covariance) = graph.gaussian(&[b.index()])?;
    /// assert!((mean[0] - 0.1).abs() < 1e-9 && (covariance[(0, 0)] - 0.5).abs() < 1e-9);
    /// # Ok::<(), wayfix_smoother::SmootherError>(())
    /// ```
    ///
    /// # Errors
    /// As [`marginals`](Self::marginals), and [`SmootherError::UnknownId`].
    pub fn gaussian(&self, variables: &[usize]) -> Result<(DVector<f64>, DMatrix<f64>), SmootherError> {
        marginals::gaussian(self, variables)
    }

    /// Adds what a marginalization leaves.
    pub(super) fn add_prior(&mut self, prior: LinearPrior) {
        let found = self.batches.iter_mut().position(|batch| batch.as_any_mut().is::<LinearPriors>());
        let batch = found.unwrap_or_else(|| {
            self.batches.push(Box::new(LinearPriors::default()));
            self.batches.len() - 1
        });
        if let Some(priors) = self.batches[batch].as_any_mut().downcast_mut::<LinearPriors>() {
            priors.push(prior, self.next_residual);
        }
        self.next_residual += 1;
        self.forget();
    }
}
