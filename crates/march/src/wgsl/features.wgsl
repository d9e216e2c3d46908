// What a scene needs beyond the least. Known when it is linked: of a branch on one of these, the side that is taken
// stays and the other goes, with all that only it reached.

// Some of the scene is met without marching; some is left to march; that lies in a box.
override ANALYTIC: bool;
override MARCHED: bool;
override CLIPPED: bool;
// All of that is met in closed form, as far as it is sampled at a place.
override COPIES: bool;
// Either of the first and the last; some rays are marched, be it to see how narrowly they pass.
override PRE_INTERSECTS: bool;
override ANY_MARCHED: bool;
// Some light throws a shadow; some light's shadow is soft.
override SHADOWS: bool;
override SOFT_SHADOWS: bool;
// Some light stands at a point; some of those shine in a cone.
override POSITIONAL_LIGHTS: bool;
override SPOT_LIGHTS: bool;
// Surfaces mirror each other.
override REFLECTIONS: bool;
// Light from everywhere does not reach everything.
override OCCLUSION: bool;
// The background changes with the direction.
override SKY: bool;
// What is far away fades, and to a colour of its own.
override FOG: bool;
override FOG_COLOR: bool;
// Rays from the eye are parallel.
override PARALLEL: bool;
// Rays from the eye visit only those rounds of loops that can matter to them.
override CULLED: bool;
// There are others then.
override CULLED_BY_CELL: bool;
// What is asked for is not how often the field was evaluated, but how many rounds of loops were visited.
override INSTRUMENTED: bool;
