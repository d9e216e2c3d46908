//! Meshes: triangles, time, defects, and how far mesh and surface are from each other.

use std::collections::HashMap;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use anyhow::{Result, anyhow};
use cpu_time::ProcessTime;
use fidget::mesh::{Octree, Settings};
use fidget::shape::BoundShape;
use sdfc::{MeshOptions, MeshSize};

use crate::model::Model;

/// A triangle mesh of either program.
pub struct Meshed {
    pub points: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
    /// CPU time of the process, and elapsed time, for mesh and certificate.
    pub time: [Duration; 2],
    /// What is known without measuring.
    pub note: String,
}

impl Meshed {
    /// The numbers of edges with one triangle, and with more than two or two in one direction.
    pub fn bad_edges(&self) -> [usize; 2] {
        let mut uses: HashMap<[u32; 2], [u32; 2]> = HashMap::new();
        for [a, b, c] in &self.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let counts = uses.entry([*from.min(to), *from.max(to)]).or_default();
                counts[usize::from(from > to)] += 1;
            }
        }
        let open = uses.values().filter(|[along, back]| along + back == 1).count();
        let other = uses.values().filter(|&&counts| counts != [1, 1]).count() - open;
        [open, other]
    }

    pub fn corners(&self, triangle: [u32; 3]) -> [[f64; 3]; 3] {
        triangle.map(|index| self.points[index as usize])
    }

    /// The mesh as a binary STL file, for other programs.
    pub fn stl(&self) -> Vec<u8> {
        let mut file = vec![0; 80];
        file.extend((self.triangles.len() as u32).to_le_bytes());
        for &triangle in &self.triangles {
            file.extend([0; 12]);
            for value in self.corners(triangle).as_flattened() {
                file.extend((*value as f32).to_le_bytes());
            }
            file.extend([0; 2]);
        }
        file
    }
}

/// The mesh of sdfc, with an error as a fraction of the longest side of the scene's bounds.
pub fn by_sdfc(model: &Model, error: f64) -> Result<Meshed> {
    let (clock, cpu) = (Instant::now(), ProcessTime::now());
    let scene = model.scene()?;
    let options = MeshOptions::new().error(MeshSize::Relative(error));
    let mesh = scene.mesh(&options, &mut |_| ControlFlow::Continue(()))?;
    let certificate = &mesh.certificate;
    let note = match certificate.undecided {
        0 => format!("proven to {:.3e}", certificate.error),
        count => format!("{:.3e}, {count} boxes undecided", certificate.error),
    };
    let time = [cpu.elapsed(), clock.elapsed()];
    Ok(Meshed { points: mesh.vertices, triangles: mesh.triangles, time, note })
}

/// The mesh of Fidget, in the cube of the model's view, by an octree of a depth.
pub fn by_fidget(model: &Model, depth: u8) -> Result<Meshed> {
    let (view, tree) = (model.view()?, model.tree()?);
    let (clock, cpu) = (Instant::now(), ProcessTime::now());
    let (context, root) = model.context(tree.as_ref())?;
    let shape = BoundShape::try_from(fidget::jit::JitShape::new(&context, root)?)?;
    let settings = Settings { depth, world_to_model: view.matrix(), ..Settings::default() };
    let octree = Octree::build(&shape, &settings).ok_or_else(|| anyhow!("cancelled"))?;
    let mesh = octree.walk_dual();
    let time = [cpu.elapsed(), clock.elapsed()];
    let points = mesh.vertices.iter().map(|v| [v.x, v.y, v.z].map(f64::from)).collect();
    let triangles = mesh.triangles.iter().map(|t| [t.x, t.y, t.z].map(|i| i as u32)).collect();
    Ok(Meshed { points, triangles, time, note: format!("depth {depth}") })
}
