/// The share of the last views for which something holds: an average that forgets.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(super) struct RunningShare(pub(super) f64);

impl RunningShare {
    /// After one more of about `views` that count.
    pub(super) fn after(self, holds: bool, views: f64) -> Self {
        let share = if holds { 1.0 } else { 0.0 };
        Self(self.0 + (share - self.0) / views.max(1.0))
    }
}
