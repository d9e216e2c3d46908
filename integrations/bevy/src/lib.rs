//! Draws compiled sdfc scenes in Bevy, among meshes, with depth, light and shadows.

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
