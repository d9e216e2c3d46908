// Compiles shaders, each { label, text }, with the browser's own compilers. Returns the errors, one
// line each.

async function wgsl(shaders) {
    const adapter = await navigator.gpu?.requestAdapter();
    if (!adapter) return ["there is no WebGPU adapter"];
    const device = await adapter.requestDevice();
    const errors = [];
    for (const { label, text } of shaders) {
        const module = device.createShaderModule({ code: text });
        for (const { type, lineNum, message } of (await module.getCompilationInfo()).messages) {
            if (type === "error") errors.push(`${label}: line ${lineNum}: ${message}`);
        }
    }
    return errors;
}

// Does not link: that would generate machine code for the CPU, which takes a second per shader.
function glsl_es(shaders) {
    const gl = document.createElement("canvas").getContext("webgl2");
    if (!gl) return ["there is no WebGL 2"];
    const errors = [];
    for (const { label, text } of shaders) {
        const shader = gl.createShader(gl.FRAGMENT_SHADER);
        gl.shaderSource(shader, text);
        gl.compileShader(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) {
            errors.push(`${label}: ${gl.getShaderInfoLog(shader)}`);
        }
        gl.deleteShader(shader);
    }
    return errors;
}
