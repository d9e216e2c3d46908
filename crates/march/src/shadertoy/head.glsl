// A whole shader for shadertoy.com: paste it into a new one. The params of the scene come first, as constants to
// be edited; dragging the mouse turns the camera.
