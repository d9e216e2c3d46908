//! The material of a scene: its buffers, and the pipeline that its shader needs.

use std::hash::Hash;

use bevy::asset::{Asset, Handle, uuid_handle};
use bevy::ecs::system::SystemParamItem;
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{Material, MaterialPipeline, MaterialPipelineKey, MeshPipelineKey};
use bevy::prelude::AlphaMode;
use bevy::reflect::TypePath;
use bevy::render::render_resource::{
    AsBindGroup, AsBindGroupError, BindGroupLayout, BindGroupLayoutEntry, BindingResources,
    BindingType, BufferBindingType, BufferInitDescriptor, BufferUsages, Face, OwnedBindingResource,
    RenderPipelineDescriptor, ShaderStages, SpecializedMeshPipelineError, UnpreparedBindGroup,
};
use bevy::render::renderer::RenderDevice;
use bevy::shader::{Shader, ShaderRef};

/// The binding of [`SurfaceBlock`].
const SURFACE_BINDING: u32 = 0;
/// The binding of the scene's params. Its lists have the next one.
pub(crate) const SCENE_BINDING: u32 = 1;

/// Bytes of a buffer that no shader reads. A uniform buffer has at least 16.
const EMPTY: [u8; 16] = [0; 16];

/// Stands for the shader that [`SdfcMaterial::specialize`] puts in its place. Without a fragment
/// shader for prepasses, Bevy draws shadows of opaque materials without one.
const PLACEHOLDER: Handle<Shader> = uuid_handle!("0a53b1d0-9f1c-4d52-8c8f-2f60a3a8a7b1");

/// The material of one entity that shows a scene. The plugin makes it, and keeps it as the entity's
/// [`SdfcSolid`](crate::SdfcSolid) says.
#[derive(Asset, TypePath, Clone, Debug)]
pub struct SdfcMaterial {
    pub(crate) shader: Handle<Shader>,
    pub(crate) surface: SurfaceBlock,
    pub(crate) params: Vec<u8>,
    pub(crate) lists: Vec<u8>,
}

/// What `surface.wgsl` reads of an entity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SurfaceBlock {
    /// Lowest corner of the box, in the scene's coordinates.
    pub(crate) low: [f32; 3],
    /// Highest corner.
    pub(crate) high: [f32; 3],
    /// Linear red, green, blue.
    pub(crate) color: [f32; 3],
    /// Perceptual roughness, 0 to 1.
    pub(crate) roughness: f32,
    /// 0 to 1.
    pub(crate) metallic: f32,
    /// As in `StandardMaterial`, 0 to 1.
    pub(crate) reflectance: f32,
}

/// The part of a material that its pipeline depends on: each scene has a shader of its own.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct SdfcMaterialKey {
    shader: Handle<Shader>,
}

impl SurfaceBlock {
    /// The bytes in the layout of `surface.wgsl`.
    fn bytes(&self) -> Vec<u8> {
        let Self { low, high, color, roughness, metallic, reflectance } = *self;
        let vectors = [low, high, color].into_iter().flat_map(|[x, y, z]| [x, y, z, 1.0]);
        let words = vectors.chain([roughness, metallic, reflectance, 0.0]);
        words.flat_map(f32::to_le_bytes).collect()
    }
}

impl AsBindGroup for SdfcMaterial {
    type Data = SdfcMaterialKey;
    type Param = ();

    fn label() -> &'static str {
        "sdfc"
    }

    fn bind_group_data(&self) -> Self::Data {
        SdfcMaterialKey { shader: self.shader.clone() }
    }

    fn unprepared_bind_group(
        &self,
        _layout: &BindGroupLayout,
        device: &RenderDevice,
        _param: &mut SystemParamItem<'_, '_, Self::Param>,
        _force_no_bindless: bool,
    ) -> Result<UnpreparedBindGroup, AsBindGroupError> {
        let buffer = |binding: u32, bytes: &[u8], usage: BufferUsages| {
            let contents = if bytes.is_empty() { &EMPTY } else { bytes };
            let descriptor = BufferInitDescriptor { label: Some("sdfc"), contents, usage };
            let made = device.create_buffer_with_data(&descriptor);
            (binding, OwnedBindingResource::Buffer(made))
        };
        let bindings = BindingResources(vec![
            buffer(SURFACE_BINDING, &self.surface.bytes(), BufferUsages::UNIFORM),
            buffer(SCENE_BINDING, &self.params, BufferUsages::UNIFORM),
            buffer(SCENE_BINDING + 1, &self.lists, BufferUsages::STORAGE),
        ]);
        Ok(UnpreparedBindGroup { bindings })
    }

    fn bind_group_layout_entries(
        _device: &RenderDevice,
        _force_no_bindless: bool,
    ) -> Vec<BindGroupLayoutEntry> {
        // All scenes have the same layout, because Bevy asks for one per type of material.
        let lists = BufferBindingType::Storage { read_only: true };
        let types = [
            (SURFACE_BINDING, BufferBindingType::Uniform),
            (SCENE_BINDING, BufferBindingType::Uniform),
            (SCENE_BINDING + 1, lists),
        ];
        let entry = |(binding, ty)| BindGroupLayoutEntry {
            binding,
            visibility: ShaderStages::FRAGMENT,
            ty: BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
            count: None,
        };
        types.map(entry).to_vec()
    }
}

impl Material for SdfcMaterial {
    fn fragment_shader() -> ShaderRef {
        PLACEHOLDER.into()
    }

    fn prepass_fragment_shader() -> ShaderRef {
        PLACEHOLDER.into()
    }

    /// A material with a mask: the shader discards rays that miss, in prepasses and shadows too.
    fn alpha_mode(&self) -> AlphaMode {
        AlphaMode::Mask(0.5)
    }

    fn specialize(
        _pipeline: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        _layout: &MeshVertexBufferLayoutRef,
        key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let unclipped = key.mesh_key.contains(MeshPipelineKey::UNCLIPPED_DEPTH_ORTHO);
        // The far sides of the box are there too if the camera is inside it. For a directional
        // light they may be clipped by the far plane, and the light is never inside.
        descriptor.primitive.cull_mode = Some(if unclipped { Face::Back } else { Face::Front });
        if let Some(fragment) = &mut descriptor.fragment {
            fragment.shader = key.bind_group_data.shader;
            if unclipped {
                fragment.shader_defs.push("SDFC_UNCLIPPED".into());
            }
        }
        Ok(())
    }
}
