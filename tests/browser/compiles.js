// Compiles shaders with the browser's own compilers. Each is { place, text }; gives what is wrong, one line each.

async function wgsl(shaders) {
    const adapter = await navigator.gpu?.requestAdapter();
    if (!adapter) return ["there is no WebGPU adapter"];
    const device = await adapter.requestDevice();
    const wrong = [];
    for (const { place, text } of shaders) {
        const module = device.createShaderModule({ code: text });
        for (const { type, lineNum, message } of (await module.getCompilationInfo()).messages) {
            if (type === "error") wrong.push(`${place}: line ${lineNum}: ${message}`);
        }
    }
    return wrong;
}

// Not linked: that makes machine code for the processor, which takes a second a picture.
function glsl_es(shaders) {
    const gl = document.createElement("canvas").getContext("webgl2");
    if (!gl) return ["there is no WebGL 2"];
    const wrong = [];
    for (const { place, text } of shaders) {
        const shader = gl.createShader(gl.FRAGMENT_SHADER);
        gl.shaderSource(shader, text);
        gl.compileShader(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) {
            wrong.push(`${place}: ${gl.getShaderInfoLog(shader)}`);
        }
        gl.deleteShader(shader);
    }
    return wrong;
}
