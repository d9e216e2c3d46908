// A whole shader for shadertoy.com: paste it into a new one. The params of the scene come first, as
// constants that you can edit; dragging the mouse turns the camera.
