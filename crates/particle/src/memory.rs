use crate::ParticleError;

/// A list of `n` copies, or [`ParticleError::TooMany`] instead of the end of the program.
pub(crate) fn filled<T: Clone>(n: usize, value: T) -> Result<Vec<T>, ParticleError> {
    let mut list = with_room(n)?;
    list.resize(n, value);
    Ok(list)
}

/// An empty list with room for `n`.
pub(crate) fn with_room<T>(n: usize) -> Result<Vec<T>, ParticleError> {
    let mut list = Vec::new();
    list.try_reserve_exact(n).map_err(|_| ParticleError::TooMany { requested: n })?;
    Ok(list)
}
