//! The connected parts of a mesh.

use serde::Serialize;

use crate::surface::Mesh;

/// A connected part of a closed mesh, without a border. [`Mesh::shells`] finds them.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Shell {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// The volume within the shell, in cubic scene units; negative for a cavity.
    pub volume: f64,
    /// True if it is the boundary of a hollow within a solid.
    pub is_cavity: bool,
    /// Number of holes through it, such as 1 for a ring: the genus `g` of Euler's formula
    /// `vertices - edges + triangles = 2 - 2 g`. `None` if no closed surface has
    /// these numbers of vertices and triangles.
    pub holes: Option<usize>,
    /// Lowest and highest corner of a box around it.
    pub bounds: [[f64; 3]; 2],
}

impl Mesh {
    /// Returns the connected parts, those with the greatest volume first.
    pub fn shells(&self) -> Vec<Shell> {
        let mut parts = Parts::new(self.vertices.len());
        for [a, b, c] in &self.triangles {
            parts.join(*a, *b);
            parts.join(*b, *c);
        }
        let mut shells: Vec<Option<Shell>> = vec![None; self.vertices.len()];
        for (id, position) in (0u32..).zip(&self.vertices) {
            let shell = shells[parts.first(id) as usize].get_or_insert(Shell {
                vertices: 0,
                triangles: 0,
                volume: 0.0,
                is_cavity: false,
                holes: None,
                bounds: [*position; 2],
            });
            shell.vertices += 1;
            for axis in 0..3 {
                shell.bounds[0][axis] = shell.bounds[0][axis].min(position[axis]);
                shell.bounds[1][axis] = shell.bounds[1][axis].max(position[axis]);
            }
        }
        for triangle in &self.triangles {
            let first = parts.first(triangle[0]) as usize;
            // About a point of the shell, because far from it digits cancel.
            let near = self.vertices[first];
            if let Some(shell) = &mut shells[first] {
                shell.triangles += 1;
                shell.volume += self.volume_from(near, *triangle);
            }
        }
        let mut shells: Vec<Shell> = shells.into_iter().flatten().collect();
        // Vertices without triangles are no shells.
        shells.retain(|shell| shell.triangles > 0);
        for shell in &mut shells {
            shell.is_cavity = shell.volume < 0.0;
            shell.holes = holes(shell.vertices, shell.triangles);
        }
        shells.sort_by(|a, b| b.volume.abs().total_cmp(&a.volume.abs()));
        shells
    }
}

/// Returns the genus of a closed surface of triangles, whose edges belong to two triangles each.
fn holes(vertices: usize, triangles: usize) -> Option<usize> {
    // 2 - 2 g = v - 3 t / 2 + t
    let twice = (4 + triangles).checked_sub(2 * vertices)?;
    (twice % 4 == 0).then_some(twice / 4)
}

/// Disjoint sets of vertices (Tarjan, 1975). The first vertex of each set stands for it.
struct Parts {
    parents: Vec<u32>,
}

impl Parts {
    fn new(count: usize) -> Self {
        Self { parents: (0..count as u32).collect() }
    }

    fn first(&mut self, mut id: u32) -> u32 {
        while self.parents[id as usize] != id {
            let next = self.parents[self.parents[id as usize] as usize];
            self.parents[id as usize] = next;
            id = next;
        }
        id
    }

    fn join(&mut self, a: u32, b: u32) {
        let [a, b] = [self.first(a), self.first(b)];
        self.parents[a.max(b) as usize] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the outside of cubes with the side 1, without the squares between them.
    fn cubes(at: &[[i32; 3]]) -> Mesh {
        let mut mesh = Mesh::default();
        let mut ids = std::collections::BTreeMap::new();
        for cube in at {
            for axis in 0..3 {
                for side in [0, 1] {
                    let mut next = *cube;
                    next[axis] += 2 * side - 1;
                    if at.contains(&next) {
                        continue;
                    }
                    let corner = |[u, v]: [i32; 2]| {
                        let mut corner = *cube;
                        corner[axis] += side;
                        corner[(axis + 1) % 3] += u;
                        corner[(axis + 2) % 3] += v;
                        corner
                    };
                    let mut square = [[0, 0], [1, 0], [1, 1], [0, 1]].map(corner);
                    if side == 0 {
                        square.reverse();
                    }
                    let [a, b, c, d] = square.map(|corner| {
                        *ids.entry(corner).or_insert_with(|| {
                            mesh.vertices.push(corner.map(f64::from));
                            mesh.vertices.len() as u32 - 1
                        })
                    });
                    mesh.triangles.extend([[a, b, c], [a, c, d]]);
                }
            }
        }
        mesh
    }

    #[test]
    fn a_frame_has_a_hole_and_a_hollow_cube_has_a_cavity() {
        let frame = [[0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [1, 2], [0, 2], [0, 1]];
        let mut at: Vec<[i32; 3]> = frame.iter().map(|[x, y]| [*x, *y, 0]).collect();
        for index in 0..27 {
            let cube = [index % 3, index / 3 % 3, index / 9];
            if cube != [1, 1, 1] {
                at.push(cube.map(|x| x + 10));
            }
        }
        let mesh = cubes(&at);
        assert_eq!(mesh.open_edges(), 0);
        let shells = mesh.shells();
        let volumes: Vec<f64> = shells.iter().map(|shell| shell.volume.round()).collect();
        assert_eq!(volumes, [27.0, 8.0, -1.0]);
        let found: Vec<_> = shells.iter().map(|shell| (shell.holes, shell.is_cavity)).collect();
        assert_eq!(found, [(Some(0), false), (Some(1), false), (Some(0), true)]);
        assert_eq!(shells[2].bounds, [[11.0; 3], [12.0; 3]]);
        assert_eq!(shells.iter().map(|shell| shell.triangles).sum::<usize>(), mesh.triangles.len());
    }

    #[test]
    fn numbers_of_no_closed_surface_have_no_holes() {
        let mut mesh = cubes(&[[0; 3]]);
        mesh.triangles.pop();
        assert_eq!(mesh.shells()[0].holes, None);
        assert!(Mesh::default().shells().is_empty());
    }
}
