/// Why an operation was refused. Whatever it was called on is as it was before.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AppearanceError {
    /// A reference with this number is in the map already.
    #[error("reference {id} is in the map already")]
    TwiceTheSame {
        /// Its number.
        id: u32,
    },
}
