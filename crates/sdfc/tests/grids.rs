//! Interpolation of grids is as exact as they state.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::ops::ControlFlow;

use sdfc::{BakeOptions, Compiler, DistanceGrid, Error, MeshError, Scene};

fn scene(source: &str) -> Scene {
    Compiler::new().compile("test.sdf", source).unwrap_or_else(|errors| panic!("{errors}"))
}

fn bake(scene: &Scene, resolution: usize) -> Result<DistanceGrid, Error> {
    let options = BakeOptions::new().resolution(resolution);
    scene.bake(&options, &mut |_| ControlFlow::Continue(()))
}

#[test]
fn a_scene_may_be_smaller_than_a_unit() {
    assert_eq!(bake(&scene("sphere(0.001)"), 16).unwrap().shape, [16; 3]);
}

/// A source of pseudo-random numbers from 0 to 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// The trilinear interpolation at a point, in spacings from the first sample.
fn interpolated(grid: &DistanceGrid, at: [f64; 3]) -> f64 {
    let [width, height, _] = grid.shape;
    (0..8)
        .map(|corner| {
            let mut weight = 1.0;
            let index = [0, 1, 2].map(|axis| {
                let (whole, part) = (at[axis].floor(), at[axis].fract());
                let is_upper = corner >> axis & 1 == 1;
                weight *= if is_upper { part } else { 1.0 - part };
                whole as usize + usize::from(is_upper)
            });
            weight * f64::from(grid.values[index[0] + width * (index[1] + height * index[2])])
        })
        .sum()
}

#[test]
fn interpolation_stays_within_the_stated_error() {
    for source in [
        "sphere(1).translate(x: 3)",
        "box([1, 1.5, 2]).rotate(x: 20deg, y: 30deg)",
        "union(box([1, 0.8, 0.9]), torus(0.5, 0.3).rotate(x: 40deg), blend: smooth(0.2))",
        "box([0.5, 0.5, 0.5]).limited_repeat(spacing: 0.8, count: [2, 3, 1])",
        "box([0.4, 0.4, 1.6]).twist(rate: 60deg)",
    ] {
        let scene = scene(source);
        let grid = bake(&scene, 24).unwrap();
        assert!(grid.surface_error <= grid.interpolation_error, "{source}");
        assert_eq!(grid.values.len(), grid.shape.iter().product::<usize>(), "{source}");
        let mut field = scene.field(&scene.defaults()).unwrap();
        let (mut random, mut worst) = (Random(3), 0.0f64);
        for _ in 0..20_000 {
            let at = grid.shape.map(|side| random.next() * (side - 1) as f64);
            let point = [0, 1, 2].map(|axis| grid.origin[axis] + at[axis] * grid.spacing);
            let value = field.distance(point);
            let off = (interpolated(&grid, at) - value).abs();
            worst = worst.max(off);
            assert!(off <= grid.interpolation_error, "{source}: {off} at {point:?}");
            // Where the value is this small, the surface may cross the cell.
            if value == 0.0 {
                assert!(off <= grid.surface_error, "{source}: {off} at {point:?}");
            }
        }
        assert!(worst > 0.02 * grid.interpolation_error, "{source}: {worst} of {grid:?}");
    }
}

#[test]
fn the_error_at_a_smooth_surface_falls_with_the_square_of_the_spacing() {
    let scene = scene("sphere(1)");
    let [coarse, fine] = [24, 45].map(|resolution| bake(&scene, resolution).unwrap());
    assert!((coarse.spacing / fine.spacing - 2.0).abs() < 1e-9);
    let ratio = coarse.surface_error / fine.surface_error;
    assert!((3.5..5.0).contains(&ratio), "{ratio}");
}

#[test]
fn grids_without_cells_or_with_too_many_samples_are_refused() {
    let scene = scene("sphere(1)");
    for resolution in [0, 3, 5000, usize::MAX] {
        let result = bake(&scene, resolution);
        let is_refused = matches!(result, Err(Error::Mesh(MeshError::Resolution { .. })));
        assert!(is_refused, "{resolution}");
    }
}
