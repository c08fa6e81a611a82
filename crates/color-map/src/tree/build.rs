//! Choosing planes and sorting the rest to their sides.

use super::{
    Face, Facet, Node, Solid, Tree,
    facet::{Side, reach},
};
use crate::{
    ColorMapError,
    map::{Layer, Plane, Prism, SIDES},
};

/// Maximum number of pieces; a map with more is rejected.
const MAX_PIECES: usize = 200_000;
/// Approximate number of pieces tested to choose a plane.
const LOOKS: usize = 20_000;
/// Cost of a cut polygon, in units of imbalance.
const CUT_FACET: usize = 4;
/// A post in two pieces is drawn face by face. That costs more than any imbalance.
const CUT_SOLID: usize = 1 << 20;

/// The content of one subtree before sorting.
#[derive(Default)]
struct Heap {
    /// With the layer each is on, in map order within a layer.
    facets: Vec<(usize, Facet)>,
    solids: Vec<Solid>,
}

impl Tree {
    /// Sorts all surfaces of a map.
    pub(crate) fn build(layers: &[Layer], prisms: &[Prism]) -> Result<Self, ColorMapError> {
        let mut tree = Self { nodes: Vec::new(), root: 0 };
        let mut all = Heap::default();
        for (i, layer) in layers.iter().enumerate() {
            for decal in &layer.decals {
                let facet = Facet::new(decal.color, decal.vertices.iter().copied());
                all.facets.push((i, facet));
            }
        }
        all.solids.extend((0..prisms.len()).map(|prism| Solid { prism, faces: None }));

        // An explicit stack: a tree may be as deep as the number of planes.
        let mut n_pieces = all.facets.len() + all.solids.len();
        tree.nodes.push(Node::Leaf { solids: Vec::new() });
        let mut open = vec![(tree.root, all)];
        while let Some((slot, heap)) = open.pop() {
            let Some(cut) = best_cut(&heap, layers, prisms) else {
                tree.nodes[slot] = Node::Leaf { solids: heap.solids };
                continue;
            };
            let plane = cut.plane;
            let before = heap.facets.len() + heap.solids.len();
            let (facets, sides) = part(heap, &cut, prisms);
            n_pieces +=
                facets.len() + sides.iter().map(|s| s.facets.len() + s.solids.len()).sum::<usize>() - before;
            if n_pieces > MAX_PIECES {
                return Err(ColorMapError::TooManyPieces { limit: MAX_PIECES });
            }
            let children = sides.map(|side| {
                tree.nodes.push(Node::Leaf { solids: Vec::new() });
                open.push((tree.nodes.len() - 1, side));
                tree.nodes.len() - 1
            });
            tree.nodes[slot] = Node::Split { plane, facets, front: children[0], back: children[1] };
        }
        Ok(tree)
    }
}

/// A plane to sort by.
struct Cut {
    plane: Plane,
    /// The layer on the cut's plane, if any.
    layer: Option<usize>,
}

/// The plane with the fewest cuts and, among those, the best balance. `None` if no facet is left.
///
/// It is that of a layer, unless this would cut a post and a face of a post cuts nothing.
fn best_cut(heap: &Heap, layers: &[Layer], prisms: &[Prism]) -> Option<Cut> {
    let n_cuts_tried = (LOOKS / (heap.facets.len() + heap.solids.len()).max(1)).max(4);
    let mut on_layers: Vec<usize> = heap.facets.iter().map(|(layer, _)| *layer).collect();
    on_layers.sort_unstable();
    on_layers.dedup();
    let on_layers = on_layers.into_iter().map(|i| Cut { plane: layers[i].plane, layer: Some(i) });
    let (cost, cut) = cheapest(on_layers.collect(), n_cuts_tried, |cut| cut.price(heap, prisms).total())?;
    if cost < CUT_SOLID {
        return Some(cut);
    }
    let faces = heap.solids.iter().flat_map(|solid| {
        let prism = &prisms[solid.prism];
        prism
            .sides
            .iter()
            .copied()
            .chain([prism.top(), prism.bottom()])
            .map(|plane| Cut { plane, layer: None })
    });
    let clean = cheapest(faces.collect(), n_cuts_tried, |cut| {
        let price = cut.price(heap, prisms);
        if price.cuts == 0 && price.front > 0 && price.back > 0 { price.total() } else { usize::MAX }
    });
    match clean {
        Some((clean_cost, face)) if clean_cost < usize::MAX => Some(face),
        _ => Some(cut),
    }
}

/// The best of some evenly chosen ones.
fn cheapest(cuts: Vec<Cut>, n_cuts_tried: usize, cost: impl Fn(&Cut) -> usize) -> Option<(usize, Cut)> {
    let stride = cuts.len().div_ceil(n_cuts_tried).max(1);
    cuts.into_iter().step_by(stride).map(|cut| (cost(&cut), cut)).min_by_key(|(cost, _)| *cost)
}

struct Price {
    cuts: usize,
    front: usize,
    back: usize,
}

impl Price {
    fn total(&self) -> usize {
        self.cuts + self.front.abs_diff(self.back)
    }
}

impl Cut {
    fn price(&self, heap: &Heap, prisms: &[Prism]) -> Price {
        let mut price = Price { cuts: 0, front: 0, back: 0 };
        let mut count = |(least, most): (i8, i8), cut: usize| {
            price.cuts += if least < 0 && most > 0 { cut } else { 0 };
            price.front += usize::from(least >= 0);
            price.back += usize::from(least < 0);
        };
        for (_, facet) in heap.facets.iter().filter(|(own, _)| Some(*own) != self.layer) {
            count(facet.reach(&self.plane), CUT_FACET);
        }
        for solid in &heap.solids {
            count(prism_reach(&prisms[solid.prism], &self.plane), CUT_SOLID);
        }
        price
    }
}

/// The facets on the cut's layer, the topmost decal first, and the pieces in front of and behind the plane.
fn part(heap: Heap, cut: &Cut, prisms: &[Prism]) -> (Vec<Facet>, [Heap; 2]) {
    let (mut on_it, mut front, mut back) = (Vec::new(), Heap::default(), Heap::default());
    for (own, facet) in heap.facets {
        if Some(own) == cut.layer {
            on_it.push(facet);
            continue;
        }
        match facet.split(&cut.plane) {
            Side::Front(facet) => front.facets.push((own, facet)),
            Side::Back(facet) => back.facets.push((own, facet)),
            Side::Both(near, far) => {
                front.facets.push((own, near));
                back.facets.push((own, far));
            }
        }
    }
    for solid in heap.solids {
        match split_solid(solid, &cut.plane, prisms) {
            Side::Front(solid) => front.solids.push(solid),
            Side::Back(solid) => back.solids.push(solid),
            Side::Both(near, far) => {
                front.solids.push(near);
                back.solids.push(far);
            }
        }
    }
    on_it.reverse();
    (on_it, [front, back])
}

fn split_solid(solid: Solid, plane: &Plane, prisms: &[Prism]) -> Side<Solid> {
    let prism = &prisms[solid.prism];
    let (least, most) = prism_reach(prism, plane);
    if least >= 0 {
        return Side::Front(solid);
    }
    if most <= 0 {
        return Side::Back(solid);
    }
    let (mut near, mut far) = (Vec::new(), Vec::new());
    for Face { plane: own, facet } in solid.faces.unwrap_or_else(|| faces(prism)) {
        match facet.split(plane) {
            Side::Front(facet) => near.push(Face { plane: own, facet }),
            Side::Back(facet) => far.push(Face { plane: own, facet }),
            Side::Both(front, back) => {
                near.push(Face { plane: own, facet: front });
                far.push(Face { plane: own, facet: back });
            }
        }
    }
    let part = |faces| Solid { prism: solid.prism, faces: Some(faces) };
    Side::Both(part(near), part(far))
}

fn prism_reach(prism: &Prism, plane: &Plane) -> (i8, i8) {
    reach((0..SIDES).flat_map(|k| [prism.corner(k, prism.from), prism.corner(k, prism.to)]), plane)
}

fn faces(prism: &Prism) -> Vec<Face> {
    let (from, to) = (prism.from, prism.to);
    let face = |plane, corners: Vec<_>| Face { plane, facet: Facet::new(prism.color, corners) };
    let mut faces = vec![
        face(prism.top(), (0..SIDES).map(|k| prism.corner(k, to)).collect()),
        face(prism.bottom(), (0..SIDES).rev().map(|k| prism.corner(k, from)).collect()),
    ];
    faces.extend(prism.sides.iter().enumerate().map(|(k, &plane)| {
        let corners = [(k, from), (k + 1, from), (k + 1, to), (k, to)];
        face(plane, corners.map(|(k, z)| prism.corner(k, z)).to_vec())
    }));
    faces
}
