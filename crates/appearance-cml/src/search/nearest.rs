use std::{cmp::Ordering, collections::BinaryHeap};

use super::ReferenceMatch;

/// The order of all answers: the nearest first, by number where they are equally near.
pub(super) fn by_distance(a: &ReferenceMatch, b: &ReferenceMatch) -> Ordering {
    a.comparison.distance.total_cmp(&b.comparison.distance).then(a.id.cmp(&b.id))
}

/// The nearest so far of those that were compared.
pub(super) struct Nearest {
    n: usize,
    /// No answer is as far as this.
    max_distance: f64,
    found: BinaryHeap<Found>,
}

impl Nearest {
    /// Keeps `n` of those below a distance, at least 1.
    pub(super) fn new(n: usize, max_distance: f64) -> Self {
        Self { n, max_distance, found: BinaryHeap::new() }
    }

    /// What is farther does not count any more.
    pub(super) fn radius(&self) -> f64 {
        let farthest = self.found.peek().filter(|_| self.found.len() >= self.n);
        farthest.map_or(self.max_distance, |found| found.0.comparison.distance)
    }

    /// Takes those in that are near enough.
    pub(super) fn extend(&mut self, matches: impl IntoIterator<Item = ReferenceMatch>) {
        for found in matches.into_iter().filter(|found| found.comparison.distance < self.max_distance) {
            self.found.push(Found(found));
            if self.found.len() > self.n {
                self.found.pop();
            }
        }
    }

    pub(super) fn into_sorted(self) -> Vec<ReferenceMatch> {
        self.found.into_sorted_vec().into_iter().map(|found| found.0).collect()
    }
}

/// The farthest is the greatest.
struct Found(ReferenceMatch);

impl Ord for Found {
    fn cmp(&self, other: &Self) -> Ordering {
        by_distance(&self.0, &other.0)
    }
}

impl PartialOrd for Found {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Found {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Found {}

/// A reference that may be near; the one of the least bound is the greatest, so that it comes first.
pub(super) struct Candidate {
    /// It is not nearer.
    pub(super) bound: f64,
    pub(super) slot: u32,
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound).then(other.slot.cmp(&self.slot))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}
