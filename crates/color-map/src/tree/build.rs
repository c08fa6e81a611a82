//! Choosing planes and sorting the rest to their sides.

use nalgebra::Vector3;

use super::{
    Face, Facet, Node, Solid, Tree,
    facet::{Side, sign},
};
use crate::{
    MapError,
    map::{Layer, Plane, Prism, SIDES},
};

/// Most pieces before a map is refused.
const MAX_PIECES: usize = 200_000;
/// About so many facets are looked at to choose a plane.
const LOOKS: usize = 20_000;
/// A post in two pieces is drawn face by face, which is worth some cut polygons.
const CUT_SOLID: usize = 8;
/// One cut polygon is worth some imbalance.
const CUT_FACET: usize = 4;

/// What has to be sorted into one subtree.
#[derive(Default)]
struct Heap {
    /// With the layer each is on, in map order within a layer.
    facets: Vec<(usize, Facet)>,
    solids: Vec<Solid>,
}

impl Tree {
    /// Sorts all surfaces of a map.
    pub(crate) fn build(layers: &[Layer], prisms: &[Prism]) -> Result<Self, MapError> {
        let mut tree = Self { nodes: Vec::new(), root: 0, points: Vec::new() };
        let mut all = Heap::default();
        for (i, layer) in layers.iter().enumerate() {
            for decal in &layer.decals {
                let facet = Facet::new(decal.color, decal.vertices.iter().copied(), &mut tree.points);
                all.facets.push((i, facet));
            }
        }
        all.solids.extend((0..prisms.len()).map(|prism| Solid { prism, faces: None }));

        // A stack of our own: a tree may be as deep as the map has planes.
        let mut n_pieces = all.facets.len() + all.solids.len();
        tree.nodes.push(Node::Leaf { solids: Vec::new() });
        let mut open = vec![(tree.root, all)];
        while let Some((slot, heap)) = open.pop() {
            let Some(layer) = best_plane(&heap, layers, prisms, &tree.points) else {
                tree.nodes[slot] = Node::Leaf { solids: heap.solids };
                continue;
            };
            let plane = layers[layer].plane;
            let before = heap.facets.len() + heap.solids.len();
            let (facets, sides) = part(heap, layer, &plane, prisms, &mut tree.points);
            n_pieces +=
                facets.len() + sides.iter().map(|s| s.facets.len() + s.solids.len()).sum::<usize>() - before;
            if n_pieces > MAX_PIECES {
                return Err(MapError::TooManyPieces { limit: MAX_PIECES });
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

/// The layer whose plane cuts least and, among those, halves best. None if no facet is left.
fn best_plane(heap: &Heap, layers: &[Layer], prisms: &[Prism], points: &[Vector3<f64>]) -> Option<usize> {
    let mut candidates: Vec<usize> = heap.facets.iter().map(|(layer, _)| *layer).collect();
    candidates.sort_unstable();
    candidates.dedup();
    let n_looks = (LOOKS / heap.facets.len().max(1)).max(4);
    let stride = candidates.len().div_ceil(n_looks).max(1);
    candidates
        .into_iter()
        .step_by(stride)
        .min_by_key(|&layer| cost(heap, layer, &layers[layer].plane, prisms, points))
}

fn cost(heap: &Heap, layer: usize, plane: &Plane, prisms: &[Prism], points: &[Vector3<f64>]) -> usize {
    let (mut cuts, mut front, mut back) = (0, 0_usize, 0_usize);
    for (_, facet) in heap.facets.iter().filter(|(own, _)| *own != layer) {
        let sides = facet.edges.iter().map(|edge| sign(plane.distance(&points[edge.corner])));
        let (least, most) = sides.fold((0, 0), |(least, most), s| (s.min(least), s.max(most)));
        cuts += if least < 0 && most > 0 { CUT_FACET } else { 0 };
        front += usize::from(least >= 0);
        back += usize::from(least < 0);
    }
    for solid in &heap.solids {
        let (least, most) = reach(&prisms[solid.prism], plane);
        cuts += if least < 0 && most > 0 { CUT_SOLID * CUT_FACET } else { 0 };
    }
    cuts + front.abs_diff(back)
}

/// What lies on the layer itself, the topmost decal first, and what is in front of and behind its plane.
fn part(
    heap: Heap,
    layer: usize,
    plane: &Plane,
    prisms: &[Prism],
    points: &mut Vec<Vector3<f64>>,
) -> (Vec<Facet>, [Heap; 2]) {
    let (mut on_it, mut front, mut back) = (Vec::new(), Heap::default(), Heap::default());
    for (own, facet) in heap.facets {
        if own == layer {
            on_it.push(facet);
            continue;
        }
        match facet.split(plane, points) {
            Side::Front(facet) => front.facets.push((own, facet)),
            Side::Back(facet) => back.facets.push((own, facet)),
            Side::Both(near, far) => {
                front.facets.push((own, near));
                back.facets.push((own, far));
            }
        }
    }
    for solid in heap.solids {
        match split_solid(solid, plane, prisms, points) {
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

fn split_solid(solid: Solid, plane: &Plane, prisms: &[Prism], points: &mut Vec<Vector3<f64>>) -> Side<Solid> {
    let prism = &prisms[solid.prism];
    let (least, most) = reach(prism, plane);
    if least >= 0 {
        return Side::Front(solid);
    }
    if most <= 0 {
        return Side::Back(solid);
    }
    let (mut near, mut far) = (Vec::new(), Vec::new());
    for Face { plane: own, facet } in solid.faces.unwrap_or_else(|| faces(prism, points)) {
        match facet.split(plane, points) {
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

/// Signs of the least and the largest distance of a prism's corners from a plane.
fn reach(prism: &Prism, plane: &Plane) -> (i8, i8) {
    let corners = (0..SIDES).flat_map(|k| [prism.corner(k, prism.from), prism.corner(k, prism.to)]);
    corners
        .map(|corner| sign(plane.distance(&corner)))
        .fold((1, -1), |(least, most), s| (s.min(least), s.max(most)))
}

fn faces(prism: &Prism, points: &mut Vec<Vector3<f64>>) -> Vec<Face> {
    let mut facet = |corners: Vec<Vector3<f64>>| Facet::new(prism.color, corners, points);
    let mut faces = vec![
        Face { plane: prism.top(), facet: facet((0..SIDES).map(|k| prism.corner(k, prism.to)).collect()) },
        Face {
            plane: prism.bottom(),
            facet: facet((0..SIDES).rev().map(|k| prism.corner(k, prism.from)).collect()),
        },
    ];
    faces.extend(prism.sides.iter().enumerate().map(|(k, &plane)| {
        let corner = |k, z| prism.corner(k, z);
        let corners = vec![
            corner(k, prism.from),
            corner(k + 1, prism.from),
            corner(k + 1, prism.to),
            corner(k, prism.to),
        ];
        Face { plane, facet: facet(corners) }
    }));
    faces
}
