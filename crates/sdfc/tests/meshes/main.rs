//! Meshes are closed, oriented and free of self-intersections, and their certificates are true.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod cases;
mod crossing;
mod nearness;
mod refused;

use std::ops::ControlFlow;

use sdfc::{Compiler, Mesh, MeshOptions, MeshSize, Scene};

/// Compiles a scene.
fn scene(source: &str) -> Scene {
    Compiler::new().compile("test.sdf", source).unwrap_or_else(|errors| panic!("{errors}"))
}

/// Meshes a scene with an error relative to its size.
fn mesh(scene: &Scene, relative: f64) -> Mesh {
    let options = MeshOptions::new().error(MeshSize::Relative(relative));
    scene.mesh(&options, &mut |_| ControlFlow::Continue(())).unwrap()
}

/// Checks what holds for every mesh.
fn check(mesh: &Mesh, name: &str) {
    assert!(!mesh.triangles.is_empty(), "{name}: no triangles");
    assert_eq!(mesh.open_edges(), 0, "{name}: open edges");
    assert!(crossing::has_one_fan_per_vertex(mesh), "{name}: a vertex joins two sheets");
    assert!(mesh.volume() > 0.0, "{name}: inside out");
    let crossings = crossing::crossings(mesh);
    assert!(crossings.is_empty(), "{name}: triangles cross: {crossings:?}");
}
