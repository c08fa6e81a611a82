use crate::ParticleError;

/// A list of `n` copies, or [`ParticleError::TooMany`] instead of the end of the program.
pub(crate) fn filled<T: Clone>(n: usize, value: T) -> Result<Vec<T>, ParticleError> {
    let mut list = Vec::new();
    resize(&mut list, n, value)?;
    Ok(list)
}

/// Makes `list` as long as `n`; it is as it was when there is no room.
pub(crate) fn resize<T: Clone>(list: &mut Vec<T>, n: usize, value: T) -> Result<(), ParticleError> {
    reserve(list, n)?;
    list.resize(n, value);
    Ok(())
}

/// Makes room for `n` in all.
pub(crate) fn reserve<T>(list: &mut Vec<T>, n: usize) -> Result<(), ParticleError> {
    let more = n.saturating_sub(list.len());
    list.try_reserve_exact(more).map_err(|_| ParticleError::TooMany { requested: n })
}

/// An empty list with room for `n`.
pub(crate) fn with_capacity<T>(n: usize) -> Result<Vec<T>, ParticleError> {
    let mut list = Vec::new();
    reserve(&mut list, n)?;
    Ok(list)
}
