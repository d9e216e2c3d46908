//! Closed triangle meshes and contours of signed distance functions, with a proven error.
//!
//! # What
//!
//! [`mesh()`] makes a [`Mesh`] of a program's surface. The mesh is closed, consistently oriented
//! and free of self-intersections. Its [`MeshCertificate`] says what is proven about the distance
//! between mesh and surface, and where nothing is proven. [`contour()`] makes a [`Contour`]: closed
//! paths around the section by a plane, by the same steps in a quadtree. [`measure()`] gives
//! [`Measurements`]: volume and more, as intervals that hold the truth. [`bake()`] gives a
//! [`DistanceGrid`] of samples.
//!
//! # How
//!
//! 1. An octree is refined until each cell is proven to be empty, or the triangles that it would
//!    have are near the surface (`examine`, `refine`).
//! 2. The surface crosses the boundary of each cell in loops (`loops`). A loop is filled by
//!    triangles that lie within the cell (`patch`), so triangles of different cells meet only in
//!    the face between them. Vertices within cells and faces are placed on sharp edges and corners.
//! 3. The mesh is compared with the field, independent of the octree (`certify`). Where that fails,
//!    cells are divided and the mesh is made again.
//!
//! All bounds are computed by affine arithmetic ([`Affine`](sdfc_graph::eval::Affine)).
//!
//! ```
//! use std::ops::ControlFlow;
//!
//! use sdfc_graph::eval::FrameValues;
//! use sdfc_graph::{Dim, Graph, Program};
//! use sdfc_mesh::{MeshFormat, MeshOptions, mesh};
//!
//! let mut graph = Graph::new();
//! let p = graph.point(0, Dim::Three);
//! let (length, radius) = (graph.length(p), graph.number(0.5));
//! let ball = graph.sub(length, radius);
//! let program = Program { graph, distance: Some(ball), ..Program::default() };
//!
//! let options = MeshOptions::new([[-0.5; 3], [0.5; 3]], 0.02);
//! let ball = mesh(&program, &FrameValues::default(), &options, &mut |_| ControlFlow::Continue(()))?;
//! assert!(ball.certificate.is_proven);
//! assert_eq!(ball.open_edges(), 0);
//! let file = MeshFormat::Stl.encode(&ball)?;
//! assert_eq!(file.len(), 84 + 50 * ball.triangles.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Limits
//!
//! The number of cells is limited ([`MeshOptions::max_cells`]). Positions need more digits than
//! the error: [`MeshError::TooFine`].

#![allow(clippy::needless_range_loop, reason = "an index is an axis, of several vectors")]

mod arc;
mod bake;
mod build;
mod certify;
mod clearance;
mod contour;
mod curve;
mod error;
mod examine;
mod extent;
mod fan;
mod field;
mod grid;
mod half_space;
mod loops;
mod make;
mod measurement;
mod mesh;
mod moments;
mod nearness;
mod normals;
mod outline;
mod patch;
mod plane;
mod polygon;
mod qef;
mod refine;
mod report;
mod shell;
mod simplify;
mod surface;
mod surroundings;
mod tree;
mod vector;
mod wall;
mod wedge;
mod witness;
mod write;

pub use bake::{BakeOptions, DistanceGrid, bake};
pub use clearance::{Clearance, clearance};
pub use contour::{Contour, ContourCertificate, ContourPath, contour};
pub use error::{MeshError, MeshOptions, Phase, Progress};
pub use measurement::{MeasureOptions, Measurements, Proven, measure};
pub use mesh::mesh;
pub use plane::Plane;
pub use report::{ContourReport, MeshReport};
pub use shell::Shell;
pub use surface::{Mesh, MeshCertificate};
pub use wall::{Wall, thinnest_wall};
pub use write::{ContourFormat, EncodeError, GridFormat, MeshFormat};
