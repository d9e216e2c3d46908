//! Example scenes of sdfc, as text: names and sources.
//!
//! The programs have them built in. Another crate cannot name the files, because a package on
//! crates.io holds only its own folder.
//!
//! ```
//! let (name, source) = sdfc_examples::BASICS[0];
//! assert_eq!(name, "balloon");
//! assert!(source.starts_with("//"));
//! ```

macro_rules! scenes {
    ($($name:literal)*) => {
        [$(($name, include_str!(concat!($name, ".sdf")))),*]
    };
}

/// The scene that `sdfc new` writes.
pub const NEW: &str = include_str!("new.sdf");

/// The scenes of this folder, each of which shows one thing, in alphabetical order.
pub const BASICS: [(&str, &str); 31] = scenes![
    "balloon" "blends" "booleans" "comprehension" "conditions" "gear" "gyroid_lattice" "lambdas"
    "lantern" "lettering" "mandelbulb" "materials" "menger_sponge" "minimal_surfaces" "own_shapes"
    "params" "pawn" "pebbles" "planar" "polyhedra" "profiles" "recursion" "round" "snowman" "solids"
    "surface_directions" "table" "terrain" "time" "transforms" "twist"
];

/// The scenes of `sdfc bench --suite`, by their paths.
pub const BENCH: [(&str, &str); 5] = [
    ("course/union.sdf", include_str!("course/union.sdf")),
    ("course/subtraction.sdf", include_str!("course/subtraction.sdf")),
    ("course/intersection.sdf", include_str!("course/intersection.sdf")),
    ("course/blend.sdf", include_str!("course/blend.sdf")),
    ("bench/thirty.sdf", include_str!("bench/thirty.sdf")),
];

/// The scenes of `sdfc faults`, which a simple marching loop gets wrong.
pub const FAULTS: [(&str, &str); 4] = [
    ("overshoot", include_str!("faults/overshoot.sdf")),
    ("stall", include_str!("faults/stall.sdf")),
    ("small", include_str!("faults/small.sdf")),
    ("far", include_str!("faults/far.sdf")),
];
