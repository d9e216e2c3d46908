//! Keeps the meshes and materials of solids as the solids state them.

use std::collections::HashMap;

use bevy::asset::{AssetId, Assets, Handle};
use bevy::diagnostic::FrameCount;
use bevy::ecs::prelude::*;
use bevy::log::error;
use bevy::math::Vec3;
use bevy::math::primitives::Cuboid;
use bevy::mesh::{Mesh, Mesh3d};
use bevy::pbr::MeshMaterial3d;
use bevy::shader::Shader;
use bevy::time::Time;
use sdfc::FrameValues;

use crate::material::{SdfcMaterial, SurfaceBlock};
use crate::scene::SdfcScene;
use crate::solid::{SdfcSolid, SdfcStatus};

/// The box is wider than the scene's bounds by this fraction of its longest side, so that rounding
/// cuts off no surface that lies in a side.
const MARGIN: f32 = 1e-3;

/// The shader of each scene that is shown, and the revision of the scene that it was written for.
#[derive(Resource, Default, Debug)]
pub(crate) struct SceneShaders(HashMap<AssetId<SdfcScene>, (u64, Handle<Shader>)>);

/// What the plugin made for a solid.
#[derive(Component, Debug)]
pub(crate) struct Shown {
    revision: u64,
    /// True if the solid changes without a change of its fields.
    moves: bool,
    corners: [Vec3; 2],
    mesh: Handle<Mesh>,
    material: Handle<SdfcMaterial>,
}

/// What a solid looks like in one frame.
struct Look {
    corners: [Vec3; 2],
    params: Vec<u8>,
}

/// Makes and updates the shaders of scenes.
pub(crate) fn update_shaders(
    scenes: Res<Assets<SdfcScene>>,
    solids: Query<&SdfcSolid>,
    mut shaders: ResMut<Assets<Shader>>,
    mut made: ResMut<SceneShaders>,
) {
    made.0.retain(|id, _| scenes.contains(*id));
    for solid in &solids {
        let id = solid.scene.id();
        let Some(scene) = scenes.get(id) else { continue };
        match made.0.get_mut(&id) {
            None => {
                made.0.insert(id, (scene.revision(), shaders.add(scene.shader())));
            }
            Some((revision, handle)) if *revision != scene.revision() => {
                *revision = scene.revision();
                *handle = shaders.add(scene.shader());
            }
            Some(_) => {}
        }
    }
}

/// Makes and updates the meshes and materials of solids.
#[expect(clippy::too_many_arguments, reason = "each is a resource that the system reads or writes")]
pub(crate) fn update_solids(
    mut commands: Commands,
    time: Res<Time>,
    count: Res<FrameCount>,
    scenes: Res<Assets<SdfcScene>>,
    shaders: Res<SceneShaders>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<SdfcMaterial>>,
    mut solids: Query<(Entity, Ref<SdfcSolid>, &mut SdfcStatus, Option<&mut Shown>)>,
) {
    for (entity, solid, mut status, shown) in &mut solids {
        let id = solid.scene.id();
        let (Some(scene), Some((_, shader))) = (scenes.get(id), shaders.0.get(&id)) else {
            continue;
        };
        let is_current = |shown: &Mut<Shown>| {
            shown.revision == scene.revision() && !shown.moves && !solid.is_changed()
        };
        if shown.as_ref().is_some_and(is_current) {
            continue;
        }
        let mut frame = scene.scene().defaults();
        (frame.time, frame.frame) = (time.elapsed_secs_f64(), f64::from(count.0));
        let (look, reported) = match look(scene, &solid, frame) {
            Ok(found) => found,
            Err(message) => {
                report(&mut status, scene, SdfcStatus::Failed(message));
                continue;
            }
        };
        report(&mut status, scene, reported);
        let material = SdfcMaterial {
            shader: shader.clone(),
            surface: surface_block(&solid, look.corners),
            params: look.params,
            lists: scene.lists(),
        };
        match shown {
            None => {
                let (mesh, material) =
                    (meshes.add(box_mesh(look.corners)), materials.add(material));
                let (revision, moves) = (scene.revision(), scene.moves());
                let both = (Mesh3d(mesh.clone()), MeshMaterial3d(material.clone()));
                let shown = Shown { revision, moves, corners: look.corners, mesh, material };
                commands.entity(entity).insert((both, shown));
            }
            Some(mut shown) => {
                if shown.corners != look.corners {
                    shown.corners = look.corners;
                    if let Some(mut mesh) = meshes.get_mut(&shown.mesh) {
                        *mesh = box_mesh(look.corners);
                    }
                }
                if shown.revision != scene.revision() {
                    (shown.revision, shown.moves) = (scene.revision(), scene.moves());
                }
                if let Some(mut shown) = materials.get_mut(&shown.material) {
                    *shown = material;
                }
            }
        }
    }
}

/// Sets the status of a solid, and logs an error that is new.
fn report(status: &mut Mut<SdfcStatus>, scene: &SdfcScene, now: SdfcStatus) {
    if status.set_if_neq(now)
        && let SdfcStatus::Failed(message) = &**status
    {
        error!("{}: {message}", scene.name());
    }
}

/// What a solid looks like at a frame, with the values of its params. The status is that of
/// the first param that could not be set; the others are set.
///
/// # Errors
///
/// A message, if there is no box to draw the scene in.
fn look(
    scene: &SdfcScene,
    solid: &SdfcSolid,
    mut frame: FrameValues,
) -> Result<(Look, SdfcStatus), String> {
    let mut reported = SdfcStatus::Drawn;
    for (name, value) in &solid.params {
        let set = scene.scene().set(&mut frame, name, value.as_value());
        if let (Err(error), SdfcStatus::Drawn) = (set, &reported) {
            reported = SdfcStatus::Failed(error.to_string());
        }
    }
    let corners = match solid.bounds {
        Some(corners) => corners,
        None => {
            let corners = scene.scene().bounds_at(&frame).ok_or("the scene draws nothing")?;
            let [low, high] = corners.map(|corner| Vec3::from_array(corner.map(|x| x as f32)));
            if !low.is_finite() || !high.is_finite() {
                let advice = "state the box to draw in `SdfcSolid::bounds`";
                return Err(format!("the scene has no limit: {advice}"));
            }
            let margin = MARGIN * (high - low).max_element();
            [low - margin, high + margin]
        }
    };
    if !corners[0].cmplt(corners[1]).all() {
        return Err(format!("the box from {} to {} is empty", corners[0], corners[1]));
    }
    Ok((Look { corners, params: scene.uniform(&frame) }, reported))
}

fn box_mesh([low, high]: [Vec3; 2]) -> Mesh {
    Mesh::from(Cuboid::from_size(high - low)).translated_by((low + high) / 2.0)
}

fn surface_block(solid: &SdfcSolid, [low, high]: [Vec3; 2]) -> SurfaceBlock {
    let color = solid.base_color.to_linear();
    SurfaceBlock {
        low: low.to_array(),
        high: high.to_array(),
        color: [color.red, color.green, color.blue],
        roughness: solid.perceptual_roughness.clamp(0.089, 1.0),
        metallic: solid.metallic,
        reflectance: solid.reflectance,
    }
}
