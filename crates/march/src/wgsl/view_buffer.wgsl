// The view comes from a buffer.

@group(0) @binding(0) var<uniform> view: View;
