use super::{
    projection::{N_DIMS, Sketch},
    slot_set::SlotSet,
};

/// Sketches in leaves of a few dozen, each with the box around them: a k-d tree that grows by splitting leaves.
#[derive(Clone, Debug)]
pub(super) struct BoxTree {
    nodes: Vec<Node>,
}

/// Sketches of a leaf before it is split.
const LEAF_SIZE: usize = 48;

/// Sketches of which this share is within the radius are not worth to be looked at one by one, once so many were.
const MOST_WITHIN: f64 = 0.75;
const N_TRIED: usize = 10 * LEAF_SIZE;

#[derive(Clone, Debug)]
struct Node {
    low: Sketch,
    high: Sketch,
    content: Content,
}

#[derive(Clone, Debug)]
enum Content {
    Leaf { sketches: Vec<Sketch>, slots: Vec<u32> },
    Fork { dim: usize, at: f32, below: usize, above: usize },
}

impl Default for BoxTree {
    fn default() -> Self {
        Self { nodes: vec![Node::leaf()] }
    }
}

impl BoxTree {
    /// Takes a sketch in.
    pub(super) fn insert(&mut self, sketch: Sketch, slot: u32) {
        let mut index = 0;
        loop {
            let node = &mut self.nodes[index];
            node.stretch(&sketch);
            match &mut node.content {
                Content::Fork { dim, at, below, above } => {
                    index = if sketch[*dim] < *at { *below } else { *above };
                }
                Content::Leaf { sketches, slots } => {
                    sketches.push(sketch);
                    slots.push(slot);
                    if slots.len() > LEAF_SIZE {
                        self.split(index);
                    }
                    return;
                }
            }
        }
    }

    /// Takes a sketch out again; boxes stay as large as they were.
    pub(super) fn remove(&mut self, sketch: &Sketch, slot: u32) {
        let mut index = 0;
        loop {
            match &mut self.nodes[index].content {
                Content::Fork { dim, at, below, above } => {
                    index = if sketch[*dim] < *at { *below } else { *above };
                }
                Content::Leaf { sketches, slots } => {
                    if let Some(place) = slots.iter().position(|other| *other == slot) {
                        sketches.swap_remove(place);
                        slots.swap_remove(place);
                    }
                    return;
                }
            }
        }
    }

    /// All slots below `n_slots` whose sketches are within `radius`; where hardly any is not, those of their leaves as well.
    pub(super) fn within(&self, sketch: &Sketch, radius: f32, n_slots: usize) -> SlotSet {
        let within = radius * radius;
        let mut found = SlotSet::new(n_slots);
        let mut branches = vec![0];
        let (mut n_within, mut n_tried) = (0, 0);
        while let Some(index) = branches.pop() {
            let node = &self.nodes[index];
            if node.squared_distance(sketch) > within {
                continue;
            }
            match &node.content {
                Content::Fork { below, above, .. } => branches.extend([*below, *above]),
                Content::Leaf { slots, .. }
                    if n_tried >= N_TRIED && n_within as f64 > MOST_WITHIN * n_tried as f64 =>
                {
                    slots.iter().for_each(|slot| found.insert(*slot));
                }
                Content::Leaf { sketches, slots } => {
                    n_tried += slots.len();
                    for (other, slot) in sketches.iter().zip(slots) {
                        if squared_distance(sketch, other) <= within {
                            n_within += 1;
                            found.insert(*slot);
                        }
                    }
                }
            }
        }
        found
    }

    /// Parts a leaf at the middle of its widest extent, if there is one.
    fn split(&mut self, index: usize) {
        let Content::Leaf { sketches, slots } = &self.nodes[index].content else { return };
        let Some((dim, at)) = cut(sketches) else { return };
        let (mut below, mut above) = (Node::leaf(), Node::leaf());
        for (sketch, slot) in sketches.iter().zip(slots) {
            let side = if sketch[dim] < at { &mut below } else { &mut above };
            side.stretch(sketch);
            if let Content::Leaf { sketches, slots } = &mut side.content {
                sketches.push(*sketch);
                slots.push(*slot);
            }
        }
        let first = self.nodes.len();
        self.nodes.extend([below, above]);
        self.nodes[index].content = Content::Fork { dim, at, below: first, above: first + 1 };
    }
}

impl Node {
    fn leaf() -> Self {
        let content = Content::Leaf { sketches: Vec::new(), slots: Vec::new() };
        Self { low: [f32::INFINITY; N_DIMS], high: [f32::NEG_INFINITY; N_DIMS], content }
    }

    fn stretch(&mut self, sketch: &Sketch) {
        for (value, (low, high)) in sketch.iter().zip(self.low.iter_mut().zip(&mut self.high)) {
            (*low, *high) = (low.min(*value), high.max(*value));
        }
    }

    fn squared_distance(&self, sketch: &Sketch) -> f32 {
        let mut outside = [0.0; N_DIMS];
        for dim in 0..N_DIMS {
            outside[dim] = (self.low[dim] - sketch[dim]).max(sketch[dim] - self.high[dim]).max(0.0);
        }
        sum_of_squares(&outside)
    }
}

/// The dimension of widest extent, and the median there; `None` where all sketches are the same.
fn cut(sketches: &[Sketch]) -> Option<(usize, f32)> {
    let values = |dim: usize| sketches.iter().map(move |sketch| sketch[dim]);
    let extent = |dim: usize| values(dim).fold(f32::MIN, f32::max) - values(dim).fold(f32::MAX, f32::min);
    let dim = (0..N_DIMS).max_by(|a, b| extent(*a).total_cmp(&extent(*b)))?;
    let mut sorted: Vec<f32> = values(dim).collect();
    sorted.sort_by(f32::total_cmp);
    let middle = sorted[sorted.len() / 2];
    // Something must lie below the cut: where more than half are the least, the next larger one.
    let at = if middle > sorted[0] { middle } else { *sorted.iter().find(|value| **value > sorted[0])? };
    Some((dim, at))
}

fn squared_distance(a: &Sketch, b: &Sketch) -> f32 {
    let mut difference = [0.0; N_DIMS];
    for dim in 0..N_DIMS {
        difference[dim] = a[dim] - b[dim];
    }
    sum_of_squares(&difference)
}

/// Four sums beside each other: the compiler makes them one instruction.
fn sum_of_squares(values: &Sketch) -> f32 {
    let mut sums = [0.0; 4];
    for four in values.chunks_exact(4) {
        for lane in 0..4 {
            sums[lane] += four[lane] * four[lane];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}
