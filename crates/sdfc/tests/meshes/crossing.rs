//! Finds triangles that cross, by exact predicates.

use std::collections::{BTreeMap, BTreeSet};

use robust::{Coord3D, orient3d};
use sdfc::Mesh;

type Point = [f64; 3];

fn side([a, b, c]: [Point; 3], d: Point) -> f64 {
    let coord = |[x, y, z]: Point| Coord3D { x, y, z };
    orient3d(coord(a), coord(b), coord(c), coord(d))
}

/// True if a segment, without its ends, meets a triangle. A segment in the triangle's plane counts
/// only by its ends' neighbours.
fn pierces([a, b]: [Point; 2], triangle: [Point; 3]) -> bool {
    let [above, below] = [side(triangle, a), side(triangle, b)];
    if above * below > 0.0 || (above == 0.0 && below == 0.0) {
        return false;
    }
    let [p, q, r] = triangle;
    let signs = [side([a, b, p], q), side([a, b, q], r), side([a, b, r], p)];
    (signs.iter().all(|s| *s >= 0.0) || signs.iter().all(|s| *s <= 0.0))
        && signs.iter().any(|s| *s != 0.0)
}

fn edges([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// True if two triangles meet anywhere but in their common vertices and edges.
fn cross(mesh: &Mesh, one: [u32; 3], other: [u32; 3]) -> bool {
    let meets = |from: [u32; 3], to: [u32; 3]| {
        edges(from).into_iter().any(|edge| {
            // An edge that shares a vertex with the triangle starts on it.
            if edge.iter().any(|id| to.contains(id)) {
                return false;
            }
            pierces(edge.map(|id| mesh.vertices[id as usize]), mesh.corners(to))
        })
    };
    meets(one, other) || meets(other, one)
}

/// Pairs of crossing triangles, at most ten.
pub fn crossings(mesh: &Mesh) -> Vec<[[u32; 3]; 2]> {
    let span = |triangle: [u32; 3], axis: usize| {
        let values = mesh.corners(triangle).map(|corner| corner[axis]);
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        [least, values.iter().copied().fold(f64::NEG_INFINITY, f64::max)]
    };
    let mut sorted: Vec<([f64; 2], [u32; 3])> =
        mesh.triangles.iter().map(|triangle| (span(*triangle, 0), *triangle)).collect();
    sorted.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
    let mut found = Vec::new();
    for (index, ([_, end], one)) in sorted.iter().enumerate() {
        let rest = sorted[index + 1..].iter().take_while(|(span, _)| span[0] <= *end);
        for (_, other) in rest {
            let apart = (1..3).any(|axis| {
                let ([a, b], [c, d]) = (span(*one, axis), span(*other, axis));
                b < c || d < a
            });
            if !apart && cross(mesh, *one, *other) && found.len() < 10 {
                found.push([*one, *other]);
            }
        }
    }
    found
}

/// True if the triangles around each vertex form one closed fan.
pub fn has_one_fan_per_vertex(mesh: &Mesh) -> bool {
    let mut around: BTreeMap<u32, BTreeMap<u32, u32>> = BTreeMap::new();
    for &[a, b, c] in &mesh.triangles {
        for (at, from, to) in [(a, b, c), (b, c, a), (c, a, b)] {
            around.entry(at).or_default().insert(from, to);
        }
    }
    around.values().all(|next| {
        let Some((first, _)) = next.first_key_value() else { return false };
        let (mut at, mut seen) = (*first, BTreeSet::new());
        while seen.insert(at) {
            let Some(to) = next.get(&at) else { return false };
            at = *to;
        }
        seen.len() == next.len()
    })
}

#[test]
fn crossing_triangles_are_found() {
    let vertices = vec![
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.2, 0.2, -1.0],
        [0.2, 0.2, 1.0],
        [5.0, 5.0, 0.0],
    ];
    let triangles = vec![[0, 1, 2], [3, 4, 5]];
    let mut mesh = Mesh { vertices, triangles, ..Mesh::default() };
    assert_eq!(crossings(&mesh).len(), 1);
    mesh.vertices[3][2] = 0.5;
    assert!(crossings(&mesh).is_empty());
}
