//! All forms of a picture's shader draw the same picture on the GPU.

use std::borrow::Cow;

use libtest_mimic::Failed;
use sdfc::{FrameValues, Scene, Stage, no_progress};
use sdfc_codegen::{Lists, PictureOptions, Reflection, Shader, picture_module, shadertoy_module};
use sdfc_graph::Program;
use sdfc_render::{Gpu, Pipeline, RenderOptions, Tile, View, compare, view_bytes};
use sdfc_render::{linear_to_srgb8, uniform_values};
use wgpu::BufferUsages as Usage;

/// Width and height, as in `shadertoy.wgsl`. Copies need rows of a multiple of 256 bytes.
const SIZE: [u32; 2] = [48, 40];
const PIXEL_BYTES: u32 = 16;
const TILE: Tile = Tile { origin: [0, 0], size: SIZE };
/// The largest difference of a colour channel, in steps of 1/255.
const COLOR: u8 = 1;
/// The most pixels in a thousand that may differ, because GLSL computes the camera in 32 bits.
const EDGES: usize = 5;

const TOY: &str = include_str!("shadertoy.wgsl");

/// The devices that draw, opened once for many scenes.
pub struct Devices {
    /// The device for compute forms.
    own: Gpu,
    /// The device for fragment forms.
    device: wgpu::Device,
    queue: wgpu::Queue,
}

/// Red, green and blue of each pixel.
type Pixels = Vec<[u8; 3]>;

/// Compares the compute form for embedding with the picture of `sdfc render`.
pub fn compute(devices: &Devices, scene: &Scene) -> Result<(), Failed> {
    let (frame, view) = at_defaults(scene)?;
    let options = RenderOptions::default();
    let own = scene.picture_shader(scene.method())?;
    let slots = uniform_values(scene.program(), &frame);
    let own = Pipeline::new(&devices.own, own, slots.len())?.render(
        &view,
        &slots,
        &options,
        &mut no_progress,
    )?;

    let embedded = embedded(scene, Stage::Compute, false)?;
    let params = params(scene, &embedded.reflection());
    let pipeline = Pipeline::new(&devices.own, embedded, params.len())?;
    let drawn = pipeline.render(&view, &params, &options, &mut no_progress)?;
    let found = compare(&own.image, &drawn.image).ok_or("the sizes differ")?;
    if found.color > COLOR || found.status > 0 {
        return Err(format!("{found:?}").into());
    }
    Ok(())
}

/// Compares the fragment form with the compute form.
pub fn fragment(devices: &Devices, scene: &Scene) -> Result<(), Failed> {
    let (_, view) = at_defaults(scene)?;
    let shader = embedded(scene, Stage::Compute, false)?;
    let params = params(scene, &shader.reflection());
    let pipeline = Pipeline::new(&devices.own, shader, params.len())?;
    let drawn = pipeline.render(&view, &params, &RenderOptions::default(), &mut no_progress)?;
    let expected = drawn.image.pixels().iter().map(|pixel| eight_bits(pixel.color));

    let expected: Pixels = expected.collect();
    for rows_up in [false, true] {
        let shader = embedded(scene, Stage::Fragment, rows_up)?;
        let source = wgpu::ShaderSource::Naga(Cow::Owned(shader.into_module()));
        let buffers = [view_bytes(&view.block(TILE)), bytes(&params)];
        let found = devices.draw(source, ["vertex", "fragment"], &buffers)?;
        let mut rows: Vec<_> = found.chunks(SIZE[0] as usize).collect();
        if rows_up {
            rows.reverse();
        }
        let found = rows.concat().into_iter().map(eight_bits).collect();
        let count = differing(&found, &expected);
        if count > 0 {
            return Err(format!("{count} pixels differ by more than {COLOR}").into());
        }
    }
    Ok(())
}

/// Compares the shader for shadertoy.com with the picture of `sdfc render`.
pub fn shadertoy(devices: &Devices, scene: &Scene) -> Result<(), Failed> {
    let (frame, view) = at_defaults(scene)?;
    let slots = uniform_values(scene.program(), &frame);
    let own = Pipeline::new(&devices.own, scene.picture_shader(scene.method())?, slots.len())?;
    let own = own.render(&view, &slots, &RenderOptions::default(), &mut no_progress)?;
    let expected = own.image.pixels().iter().map(|pixel| eight_bits(pixel.color)).collect();

    let view = view_bytes(&view.block(TILE));
    let marched = scene.marched(scene.method());
    let toy = shadertoy_module(&bounded(scene, &marched.program), marched.method, &view)?;
    let text = format!("{}\n{TOY}", toy.wgsl()?);
    let source = wgpu::ShaderSource::Wgsl(Cow::Owned(text));
    let found = devices.draw(source, ["triangle", "toy"], &[])?;
    // The colours are already in sRGB.
    let found = found.into_iter().map(|[r, g, b, _]| [r, g, b].map(|c| (c * 255.0).round() as u8));
    let count = differing(&found.collect(), &expected);
    if count * 1000 > EDGES * expected.len() {
        return Err(format!("{count} pixels differ by more than {COLOR}").into());
    }
    Ok(())
}

fn at_defaults(scene: &Scene) -> Result<(FrameValues, View), Failed> {
    let frame = FrameValues::defaults(scene.params());
    let view = View::new(scene.program(), &frame, scene.bounds_at(&frame), SIZE)?;
    Ok((frame, view))
}

/// Returns the scene's program with the bounds that the marched program has, but with the scene's
/// origin.
fn bounded(scene: &Scene, marched: &Program) -> Program {
    scene.program().with_segment_bounds(marched.range.is_some(), marched.slope_range.is_some())
}

fn embedded(scene: &Scene, stage: Stage, rows_up: bool) -> Result<Shader, Failed> {
    let marched = scene.marched(scene.method());
    let (method, prefix) = (marched.method, String::new());
    let lists = Lists::Constants;
    let options = PictureOptions { method, stage, rows_up, prefix, group: 0, binding: 0, lists };
    Ok(picture_module(&bounded(scene, &marched.program), &options)?)
}

/// Returns the uniform buffer with all params at their defaults, laid out by the reflection. `time`
/// and `frame` are 0.
fn params(scene: &Scene, reflection: &Reflection) -> Vec<[f32; 4]> {
    let size = reflection.uniform.as_ref().map_or(0, |uniform| uniform.size);
    let mut words = vec![[0.0; 4]; size.div_ceil(16) as usize];
    for member in &reflection.members {
        let sdfc_graph::FrameInput::Param(index) = member.input else { continue };
        let default = scene.params()[index as usize].default;
        for (lane, value) in (0..member.size / 4).zip(default) {
            let word = (member.offset / 4 + lane) as usize;
            let truth = f32::from_bits(u32::from(value != 0.0));
            let is_bool = member.ty == sdfc_graph::Type::Bool;
            words[word / 4][word % 4] = if is_bool { truth } else { value as f32 };
        }
    }
    words
}

fn bytes(words: &[[f32; 4]]) -> Vec<u8> {
    words.as_flattened().iter().flat_map(|word| word.to_ne_bytes()).collect()
}

fn eight_bits([r, g, b, _]: [f32; 4]) -> [u8; 3] {
    [r, g, b].map(linear_to_srgb8)
}

fn differing(a: &Pixels, b: &Pixels) -> usize {
    let is_far =
        |(a, b): &(&[u8; 3], &[u8; 3])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > COLOR);
    a.iter().zip(b).filter(is_far).count()
}

impl Devices {
    pub fn open() -> Result<Self, Failed> {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.backends = wgpu::Backends::VULKAN | wgpu::Backends::METAL | wgpu::Backends::DX12;
        let instance = wgpu::Instance::new(descriptor);
        let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
        Ok(Self { own: Gpu::new()?, device, queue })
    }

    /// Draws a triangle over a texture of `SIZE` and returns its pixels, top row first. Buffers
    /// that are not empty are bound as uniforms of group 0, in order.
    fn draw(
        &self,
        source: wgpu::ShaderSource<'_>,
        [vertex, fragment]: [&str; 2],
        buffers: &[Vec<u8>],
    ) -> Result<Vec<[f32; 4]>, Failed> {
        let module =
            self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let format = wgpu::TextureFormat::Rgba32Float;
        let pipeline = self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(vertex),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(fragment),
                compilation_options: Default::default(),
                targets: &[Some(format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let [width, height] = SIZE;
        let extent = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: extent,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let buffer = |size: usize, usage| {
            let (label, size) = (None, size as u64);
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label,
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let uniforms: Vec<_> =
            (0..).zip(buffers.iter().filter(|bytes| !bytes.is_empty())).collect();
        let uniforms: Vec<(u32, wgpu::Buffer)> = uniforms
            .into_iter()
            .map(|(binding, bytes)| {
                let uniform = buffer(bytes.len(), Usage::UNIFORM | Usage::COPY_DST);
                self.queue.write_buffer(&uniform, 0, bytes);
                (binding, uniform)
            })
            .collect();
        let entries: Vec<_> = uniforms
            .iter()
            .map(|(binding, uniform)| wgpu::BindGroupEntry {
                binding: *binding,
                resource: uniform.as_entire_binding(),
            })
            .collect();
        let target = texture.create_view(&Default::default());
        let staging =
            buffer((width * height * PIXEL_BYTES) as usize, Usage::MAP_READ | Usage::COPY_DST);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &target,
                    depth_slice: None,
                    resolve_target: None,
                    ops: Default::default(),
                })],
                ..Default::default()
            });
            pass.set_pipeline(&pipeline);
            if !entries.is_empty() {
                let layout = pipeline.get_bind_group_layout(0);
                let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: None,
                    layout: &layout,
                    entries: &entries,
                });
                pass.set_bind_group(0, &group, &[]);
            }
            pass.draw(0..3, 0..1);
        }
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(width * PIXEL_BYTES),
            rows_per_image: None,
        };
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &staging, layout },
            extent,
        );
        self.queue.submit([encoder.finish()]);
        staging.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        let mapped = staging.slice(..).get_mapped_range()?;
        let float = |bytes: &[u8]| bytes.try_into().map_or(f32::NAN, f32::from_ne_bytes);
        let pixel = |bytes: &[u8]| [0, 4, 8, 12].map(|lane| float(&bytes[lane..lane + 4]));
        Ok(mapped.chunks_exact(PIXEL_BYTES as usize).map(pixel).collect())
    }
}
