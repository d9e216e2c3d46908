//! Prints a slice through a scene. A shader of this program computes the distances on the GPU.

use sdfc::bind::Bindings;
use sdfc::{Code, Compiler, ShaderOptions, wgpu};

/// The source of the scene: a ball and a block, blended.
pub const SCENE: &str =
    "param r = 0.6 in 0.1..1\nunion(sphere(r), box(0.8).translate(x: 0.9), blend: smooth(0.3))";
const SHADER: &str = "
@group(0) @binding(0) var<storage, read_write> distances: array<f32>;
@compute @workgroup_size(8, 8)
fn slice(@builtin(global_invocation_id) id: vec3u) {
    let p = vec3f((f32(id.x) - 32.0) / 16.0, (12.0 - f32(id.y)) / 8.0, 0.0);
    distances[id.x + 64u * id.y] = sdf_distance(p);
}";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for row in slice(0.8)?.chunks(64) {
        let inside = |distance: &f32| if *distance < 0.0 { '#' } else { '.' };
        println!("{}", row.iter().map(inside).collect::<String>());
    }
    Ok(())
}

/// Returns 24 rows of 64 distances, for a ball of this radius.
pub fn slice(r: f64) -> Result<Vec<f32>, Box<dyn std::error::Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;

    // The scene as functions in WGSL, and the buffers that they read, in bind group 1.
    let scene = Compiler::new().compile("scene.sdf", SCENE)?;
    let written = scene.write_shader(&ShaderOptions::new().group(1))?;
    let mut field =
        Bindings::new((&device, &queue), &scene, &written, wgpu::ShaderStages::COMPUTE)?;
    let Code::Text(text) = written.code else { return Err("WGSL is text".into()) };

    // The program's own pipeline, with the scene's layout beside its own.
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl((text + SHADER).into()),
    });
    let own = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: false },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&own), Some(field.layout())],
        ..Default::default()
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: Some(&layout),
        module: &module,
        entry_point: Some("slice"),
        compilation_options: Default::default(),
        cache: None,
    });
    let buffer = |usage| {
        let (label, size, mapped_at_creation) = (None, 64 * 24 * 4, false);
        device.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation })
    };
    let distances = buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let readable = buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
    let own = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &own,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: distances.as_entire_binding() }],
    });

    // A frame. Changing a param recompiles nothing.
    field.set("r", r)?;
    field.upload(&queue);
    let mut encoder = device.create_command_encoder(&Default::default());
    {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &own, &[]);
        pass.set_bind_group(field.group(), field.bind_group(), &[]);
        pass.dispatch_workgroups(8, 3, 1);
    }
    encoder.copy_buffer_to_buffer(&distances, 0, &readable, 0, None);
    queue.submit([encoder.finish()]);
    readable.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    device.poll(wgpu::PollType::wait_indefinitely())?;

    let bytes = readable.slice(..).get_mapped_range()?;
    let (words, _) = bytes.as_chunks::<4>();
    Ok(words.iter().map(|word| f32::from_le_bytes(*word)).collect())
}
