//! Draws compiled sdfc scenes in Bevy, among meshes, with depth, light and shadows.
//!
//! ```no_run
//! use bevy::prelude::*;
//! use sdfc_bevy::{SdfcPlugin, SdfcSolid};
//!
//! fn main() {
//!     App::new().add_plugins((DefaultPlugins, SdfcPlugin)).add_systems(Startup, setup).run();
//! }
//!
//! fn setup(mut commands: Commands, assets: Res<AssetServer>) {
//!     let bowl = assets.load("bowl.sdf");
//!     let solid = SdfcSolid::new(bowl).with("wall", 0.1);
//!     commands.spawn((solid, Transform::from_xyz(0.0, 1.0, 0.0)));
//! }
//! ```
//!
//! [`SdfcSolid`] shows a scene at the transform of its entity. The plugin gives the entity the box
//! of the scene's bounds as a mesh, and an [`SdfcMaterial`]. The material's shader is
//! `surface.wgsl` with the functions of the scene: it marches the ray of a pixel inside the box,
//! and writes depth and Bevy's lighting. Shadow passes and prepasses use the same shader.
//!
//! Lengths of a scene are Bevy's units, times the scale of the transform.

mod loader;
mod material;
mod scene;
mod solid;
mod update;

use bevy::app::{App, Plugin, PostUpdate};
use bevy::asset::{AssetApp, AssetEventSystems};
use bevy::camera::visibility::VisibilitySystems;
use bevy::ecs::schedule::IntoScheduleConfigs;
use bevy::pbr::MaterialPlugin;

pub use loader::SdfcLoader;
pub use material::{SdfcMaterial, SdfcMaterialKey};
pub use scene::{SdfcError, SdfcScene};
pub use sdfc;
pub use solid::{ParamValue, SdfcSolid, SdfcStatus};

/// Adds the asset loader for `.sdf` files, and draws each [`SdfcSolid`]. Add it after
/// `DefaultPlugins`.
#[derive(Clone, Copy, Debug, Default)]
pub struct SdfcPlugin;

impl Plugin for SdfcPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(MaterialPlugin::<SdfcMaterial>::default())
            .init_asset::<SdfcScene>()
            .init_asset_loader::<SdfcLoader>()
            .init_resource::<update::SceneShaders>()
            .add_systems(
                PostUpdate,
                (update::update_shaders, update::update_solids)
                    .chain()
                    .before(AssetEventSystems)
                    .before(VisibilitySystems::CalculateBounds),
            );
    }
}
