// The optional parts of the shader that a scene needs. The values are known when the shader is
// linked: of a branch on one of these only one side is kept, with the functions that it reaches.

// Materials depend on the normal or on the direction to the eye.
override SEEN_MATERIALS: bool;
// Some materials keep direct light away.
override UNLIT: bool;
// A part of the scene is intersected analytically; a part is marched; the marched part lies in a
// box.
override ANALYTIC: bool;
override MARCHED: bool;
override CLIPPED: bool;
// The marched part consists of copies that are intersected analytically, a few at a time.
override COPIES: bool;
// Rays are intersected analytically or clipped before they are marched; some rays are marched, if
// only to measure how narrowly they pass things.
override PRE_INTERSECTS: bool;
override ANY_MARCHED: bool;
// A light casts a shadow; a light casts a soft shadow.
override SHADOWS: bool;
override SOFT_SHADOWS: bool;
// A light has a position; a light is a spot light.
override POSITIONAL_LIGHTS: bool;
override SPOT_LIGHTS: bool;
// Surfaces reflect each other.
override REFLECTIONS: bool;
// Ambient light is occluded.
override OCCLUSION: bool;
// The background is a sky, whose colour depends on the direction.
override SKY: bool;
// The sky has another colour below the horizon.
override GROUND: bool;
// Materials mirror the sky without reflected rays.
override MIRRORS_SKY: bool;
// A picture of the surroundings is the background and the ambient light.
override ENVIRONMENT: bool;
// There is fog; the fog has a colour of its own.
override FOG: bool;
override FOG_COLOR: bool;
// Light is multiplied by the exposure or compressed by a tone curve; each of these.
override DEVELOPS: bool;
override EXPOSURE: bool;
override NEUTRAL_TONE: bool;
override FILM_TONE: bool;
// Camera rays are parallel.
override PARALLEL: bool;
// Camera rays run only those iterations of loops that can affect them.
override CULLED: bool;
// There are secondary rays as well then, which select their iterations by cell.
override CULLED_BY_CELL: bool;
// Pixels count iterations of loops instead of evaluations of the field.
override INSTRUMENTED: bool;
// The scene has bounds of the field along segments of rays.
override PROVED: bool;
// Pixels tell whether a ray passed a stretch without a proof that it is free.
override RECORDS_GAPS: bool;
// The field is divided by a large Lipschitz constant: a small value may be far from the surface.
override LOOSE: bool;
// The field is divided by Lipschitz constants; soft shadows and ambient occlusion use what it is
// without.
override ESTIMATED: bool;
// The field falls behind the distance elsewhere; soft shadows follow its gradients.
override PROJECTED: bool;
// The scene's functions contain loops.
override HAS_LOOPS: bool;
