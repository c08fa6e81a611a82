use std::convert::Infallible;

/// Evenly spaced values of a stream of unknown length: if there are too many, every second one is dropped.
#[derive(Clone, Debug)]
pub struct Decimated<T> {
    most: usize,
    stride: usize,
    n_seen: usize,
    kept: Vec<T>,
}

impl<T> Decimated<T> {
    /// Keeps at most `most` values, and at least half as many once full.
    pub fn new(most: usize) -> Self {
        Self { most: most.max(2), stride: 1, n_seen: 0, kept: Vec::new() }
    }

    /// Offers the next value.
    pub fn push(&mut self, value: T) {
        let Ok(()) = self.offer(|| Ok::<_, Infallible>(value));
    }

    /// Offers the next value, which is computed only if it is kept.
    ///
    /// # Errors
    /// Returns the error of `make`.
    pub fn offer<E>(&mut self, make: impl FnOnce() -> Result<T, E>) -> Result<(), E> {
        let wanted = self.n_seen.is_multiple_of(self.stride);
        self.n_seen += 1;
        if !wanted {
            return Ok(());
        }
        let value = make()?;
        if self.kept.len() == self.most {
            let mut index = 0;
            self.kept.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.stride *= 2;
            if !(self.n_seen - 1).is_multiple_of(self.stride) {
                return Ok(());
            }
        }
        self.kept.push(value);
        Ok(())
    }

    /// Says that something, for example figures and pictures, is of some values only, if not all are kept.
    pub fn note(&self, what: &str) -> Option<String> {
        let Self { stride, n_seen, .. } = self;
        (*stride > 1)
            .then(|| format!("The log is long: {what} are of one in {stride} of {n_seen} estimates."))
    }

    /// The kept values, in order.
    pub fn kept(&self) -> &[T] {
        &self.kept
    }

    /// Number of values offered.
    pub fn n_seen(&self) -> usize {
        self.n_seen
    }

    /// Stride between kept values.
    pub fn stride(&self) -> usize {
        self.stride
    }
}

#[cfg(test)]
mod tests {
    use super::Decimated;

    #[test]
    fn what_is_kept_is_evenly_spaced_and_never_too_much() {
        let mut decimated = Decimated::new(10);
        for value in 0..1000_usize {
            decimated.push(value);
            let (kept, stride) = (decimated.kept(), decimated.stride());
            assert!(kept.len() <= 10);
            assert!(kept.iter().enumerate().all(|(k, v)| *v == k * stride), "{kept:?}");
            assert!((kept.len() + 1) * stride > value, "the newest are there: {kept:?} of {value}");
        }
        assert!(decimated.kept().len() >= 5);
        let note = decimated.note("figures").unwrap();
        assert!(note.contains("figures are of one in 128 of 1000"), "{note}");
        assert_eq!(Decimated::<u8>::new(10).note("figures"), None);
    }
}
