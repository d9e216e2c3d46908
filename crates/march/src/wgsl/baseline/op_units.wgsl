// An interpreter of op units, as in a classroom exercise: a scene is a list of units, each an
// operation on two primitives from tables, and the distance is the minimum over the units. Each
// evaluation decodes every unit.

const PLANE: u32 = 0;
const SPHERE: u32 = 1;
const BOX: u32 = 2;

const UNION: u32 = 0;
const SUBTRACTION: u32 = 1;
const INTERSECTION: u32 = 2;
const SMOOTH_UNION: u32 = 3;

// A distance greater than any in a scene.
const EMPTY_FIELD: f32 = 1e30;

struct Unit {
    // The table and the index of each operand.
    type_a: u32,
    id_a: u32,
    type_b: u32,
    id_b: u32,
    operation: u32,
    // Width of a smooth union, greater than 0.
    width: f32,
    pad0: u32,
    pad1: u32,
}

struct Box {
    center: vec3f,
    half_size: vec3f,
}

@group(0) @binding(3) var<storage, read> units: array<Unit>;
// Unit normal, then the plane's distance from the origin along it.
@group(0) @binding(4) var<storage, read> planes: array<vec4f>;
// Centre, then radius.
@group(0) @binding(5) var<storage, read> spheres: array<vec4f>;
@group(0) @binding(6) var<storage, read> boxes: array<Box>;

fn plane_distance(plane: vec4f, p: vec3f) -> f32 {
    return dot(plane.xyz, p) - plane.w;
}

fn sphere_distance(sphere: vec4f, p: vec3f) -> f32 {
    return length(p - sphere.xyz) - sphere.w;
}

fn box_distance(box: Box, p: vec3f) -> f32 {
    let q = abs(p - box.center) - box.half_size;
    return length(max(q, vec3f())) + min(max(q.x, max(q.y, q.z)), 0.0);
}

fn primitive_distance(kind: u32, id: u32, p: vec3f) -> f32 {
    switch kind {
        case PLANE: {
            return plane_distance(planes[id], p);
        }
        case SPHERE: {
            return sphere_distance(spheres[id], p);
        }
        case BOX: {
            return box_distance(boxes[id], p);
        }
        default: {
            return EMPTY_FIELD;
        }
    }
}

fn smooth_union(a: f32, b: f32, width: f32) -> f32 {
    let h = max(width - abs(b - a), 0.0);
    return min(a, b) - h * h * (0.25 / width);
}

fn unit_distance(unit: Unit, p: vec3f) -> f32 {
    let a = primitive_distance(unit.type_a, unit.id_a, p);
    let b = primitive_distance(unit.type_b, unit.id_b, p);
    switch unit.operation {
        case UNION: {
            return min(a, b);
        }
        case SUBTRACTION: {
            return max(a, -b);
        }
        case INTERSECTION: {
            return max(a, b);
        }
        case SMOOTH_UNION: {
            return smooth_union(a, b, unit.width);
        }
        default: {
            return EMPTY_FIELD;
        }
    }
}

fn field(p: vec3f) -> f32 {
    var nearest = EMPTY_FIELD;
    for (var i = 0u; i < arrayLength(&units); i++) {
        nearest = min(nearest, unit_distance(units[i], p));
    }
    return nearest;
}
