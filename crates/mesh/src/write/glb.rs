//! Binary glTF 2.0.

use rustc_hash::FxHashMap;
use serde_json::json;

use crate::surface::Mesh;
use crate::vector::{add, cross, dot, scale, sub, unit};

/// A face whose normal differs more from that of its vertex (cosine) gets a vertex of its own, so
/// that sharp edges look sharp.
const SMOOTH: f64 = 0.85;

/// A vertex with attributes.
struct Vertex {
    position: [f32; 3],
    normal: [f32; 3],
    id: u32,
}

/// Returns vertices, and three indices for each triangle. Vertices on sharp edges occur several
/// times.
fn split(mesh: &Mesh, center: [f64; 3]) -> (Vec<Vertex>, Vec<u32>) {
    let mut known: FxHashMap<(u32, [u32; 3]), u32> = FxHashMap::default();
    let mut vertices = Vec::new();
    let mut indices = Vec::with_capacity(3 * mesh.triangles.len());
    for triangle in &mesh.triangles {
        let [a, b, c] = mesh.corners(*triangle);
        let flat = unit(cross(sub(b, a), sub(c, a)));
        for id in triangle {
            let smooth = mesh.normals[*id as usize];
            let normal = match flat {
                Some(flat) if dot(flat, smooth) < SMOOTH => flat,
                Some(_) | None => unit(smooth).unwrap_or([0.0, 0.0, 1.0]),
            };
            let normal = normal.map(|x| x as f32);
            let index = *known.entry((*id, normal.map(f32::to_bits))).or_insert_with(|| {
                let position = sub(mesh.vertices[*id as usize], center).map(|x| x as f32);
                vertices.push(Vertex { position, normal, id: *id });
                vertices.len() as u32 - 1
            });
            indices.push(index);
        }
    }
    (vertices, indices)
}

/// Writes the file. Positions are relative to the node's translation if they need more digits than
/// 32-bit floats have. `None` if the file is too large for the format.
pub(super) fn glb(mesh: &Mesh) -> Option<Vec<u8>> {
    let [lo, hi] = mesh.bounds().unwrap_or_default();
    let center = match mesh.is_single_precision {
        true => [0.0; 3],
        false => scale(add(lo, hi), 0.5),
    };
    let (vertices, indices) = split(mesh, center);
    let mut binary = Vec::new();
    let mut views = Vec::new();
    let mut push = |bytes: Vec<u8>, target: u32| {
        views.push(json!({
            "buffer": 0, "byteOffset": binary.len(), "byteLength": bytes.len(), "target": target,
        }));
        binary.extend(bytes);
        views.len() - 1
    };
    let floats = |values: &dyn Fn(&Vertex) -> [f32; 3]| -> Vec<u8> {
        vertices.iter().flat_map(values).flat_map(f32::to_le_bytes).collect()
    };
    let [lo, hi] = [lo, hi].map(|corner| sub(corner, center).map(|x| x as f32));
    let triples = |view: usize| {
        json!({
            "bufferView": view, "componentType": 5126, "count": vertices.len(), "type": "VEC3",
        })
    };
    let mut positions = triples(push(floats(&|vertex| vertex.position), 34962));
    positions["min"] = json!(lo);
    positions["max"] = json!(hi);
    let normals = triples(push(floats(&|vertex| vertex.normal), 34962));
    let mut accessors = vec![positions, normals];
    let mut attributes = json!({ "POSITION": 0, "NORMAL": 1 });
    if !mesh.colors.is_empty() {
        let color = |vertex: &Vertex| mesh.colors[vertex.id as usize].map(|x| x.clamp(0.0, 1.0));
        attributes["COLOR_0"] = json!(accessors.len());
        accessors.push(triples(push(floats(&color), 34962)));
    }
    let bytes = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
    let view = push(bytes, 34963);
    let faces = accessors.len();
    accessors.push(json!({
        "bufferView": view, "componentType": 5125, "count": indices.len(), "type": "SCALAR",
    }));
    let base = if mesh.colors.is_empty() { 0.8 } else { 1.0 };
    let document = json!({
        "asset": { "version": "2.0", "generator": "sdfc", "extras": { "certificate": mesh.certificate.to_string() } },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "translation": center }],
        "meshes": [{ "primitives": [
            { "attributes": attributes, "indices": faces, "material": 0 },
        ] }],
        "materials": [{ "pbrMetallicRoughness": {
            "baseColorFactor": [base, base, base, 1.0], "metallicFactor": 0.0,
            "roughnessFactor": 0.6,
        } }],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{ "byteLength": binary.len() }],
    });
    container(document.to_string().into_bytes(), binary)
}

fn container(mut text: Vec<u8>, mut binary: Vec<u8>) -> Option<Vec<u8>> {
    text.resize(text.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let length = 12 + 8 + text.len() + 8 + binary.len();
    let mut file = b"glTF".to_vec();
    file.extend(2u32.to_le_bytes());
    file.extend(u32::try_from(length).ok()?.to_le_bytes());
    for (kind, chunk) in [(b"JSON", text), (b"BIN\0", binary)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    Some(file)
}
