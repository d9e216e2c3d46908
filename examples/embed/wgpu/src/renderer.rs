//! The program's pipeline.

use std::error::Error;

use sdfc::bind::Bindings;
use sdfc::{Code, Compiler, Emit, ShaderOptions};

use crate::SCENES;
use crate::target::{FORMAT, Target};

/// A camera and a light.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// The origin of the rays.
    pub eye: [f32; 3],
    /// The point in the middle of the picture.
    pub target: [f32; 3],
    /// Vertical field of view in radians.
    pub fov: f32,
    /// Towards the sun, of any length.
    pub sun: [f32; 3],
    /// Ambient light.
    pub ambient: f32,
}

/// A pipeline that draws both scenes.
#[derive(Debug)]
pub struct Renderer {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pipeline: wgpu::RenderPipeline,
    camera: wgpu::Buffer,
    camera_group: wgpu::BindGroup,
    /// The scenes' buffers, in the order of [`SCENES`].
    pub scenes: Vec<Bindings>,
}

/// Bytes of `Camera` in `frame.wgsl`.
const CAMERA_BYTES: u64 = 96;

impl Renderer {
    /// Compiles the scenes, and the shader that contains them.
    ///
    /// # Errors
    ///
    /// The errors of a scene.
    pub fn new(device: wgpu::Device, queue: wgpu::Queue) -> Result<Self, Box<dyn Error>> {
        let mut text = String::new();
        let mut scenes = Vec::new();
        for ((name, source), group) in SCENES.into_iter().zip(1..) {
            let scene = Compiler::new().compile(name, source)?;
            let prefix = format!("{name}_");
            let options = ShaderOptions::new().emit(Emit::March).prefix(prefix).group(group);
            let written = scene.write_shader(&options)?;
            let fragment = wgpu::ShaderStages::FRAGMENT;
            scenes.push(Bindings::new((&device, &queue), &scene, &written, fragment)?);
            let Code::Text(functions) = written.code else { return Err("WGSL is text".into()) };
            text += &functions;
        }
        text += include_str!("frame.wgsl");

        let camera = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("camera"),
            size: CAMERA_BYTES,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let camera_layout = camera_layout(&device);
        let camera_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("camera"),
            layout: &camera_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: camera.as_entire_binding() }],
        });
        let own = std::iter::once(Some(&camera_layout));
        let layouts: Vec<_> = own.chain(scenes.iter().map(|scene| Some(scene.layout()))).collect();
        let pipeline = pipeline(&device, &layouts, text);
        Ok(Self { device, queue, pipeline, camera, camera_group, scenes })
    }

    /// Draws a picture. Returns red, green, blue and alpha of each pixel in sRGB, row by row from
    /// the top.
    ///
    /// # Errors
    ///
    /// If the device was lost.
    pub fn draw(&self, size: [u32; 2], camera: &Camera) -> Result<Vec<u8>, Box<dyn Error>> {
        for scene in &self.scenes {
            scene.upload(&self.queue);
        }
        self.queue.write_buffer(&self.camera, 0, &camera.bytes(size));
        let target = Target::new(&self.device, size);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        {
            let mut pass = target.pass(&mut encoder);
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.camera_group, &[]);
            for scene in &self.scenes {
                pass.set_bind_group(scene.group(), scene.bind_group(), &[]);
            }
            pass.draw(0..3, 0..1);
        }
        target.read(&self.device, &self.queue, encoder)
    }
}

fn camera_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let ty = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let visibility = wgpu::ShaderStages::FRAGMENT;
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("camera"),
        entries: &[wgpu::BindGroupLayoutEntry { binding: 0, visibility, ty, count: None }],
    })
}

fn pipeline(
    device: &wgpu::Device,
    layouts: &[Option<&wgpu::BindGroupLayout>],
    text: String,
) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("scenes"),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: layouts,
        ..Default::default()
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fragment"),
            compilation_options: Default::default(),
            targets: &[Some(FORMAT.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

impl Default for Camera {
    /// A camera that sees both scenes.
    fn default() -> Self {
        Self {
            eye: [2.2, 2.4, 3.0],
            target: [0.0, -0.2, 0.0],
            fov: 40f32.to_radians(),
            sun: [1.0, 2.0, 1.5],
            ambient: 0.15,
        }
    }
}

impl Camera {
    /// The bytes in the layout of `frame.wgsl`.
    fn bytes(&self, [width, height]: [u32; 2]) -> Vec<u8> {
        let forward = unit(subtract(self.target, self.eye));
        let right = unit(cross(forward, [0.0, 1.0, 0.0]));
        let up = cross(right, forward);
        let half = (self.fov / 2.0).tan();
        let [width, height] = [width as f32, height as f32];
        let (right, up) = (scaled(right, half * width / height), scaled(up, half));
        let vectors = [
            (self.eye, self.ambient),
            (right, 100.0),
            (up, 0.0),
            (forward, 0.0),
            (unit(self.sun), 0.0),
            ([width, height, 0.0], 0.0),
        ];
        let words = vectors.into_iter().flat_map(|([x, y, z], w)| [x, y, z, w]);
        words.flat_map(f32::to_le_bytes).collect()
    }
}

fn subtract(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn scaled(a: [f32; 3], factor: f32) -> [f32; 3] {
    a.map(|x| factor * x)
}

fn cross([a, b, c]: [f32; 3], [x, y, z]: [f32; 3]) -> [f32; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

fn unit(a: [f32; 3]) -> [f32; 3] {
    scaled(a, 1.0 / a.iter().map(|x| x * x).sum::<f32>().sqrt())
}
