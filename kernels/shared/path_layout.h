// What the path tracer's kernels and its reference hold in tables: surfaces, lights, paths. Not for rays and hits
// (layout.h). Feeds path_math.h, path.cl and host/render.
#ifndef GNOMON_SHARED_PATH_LAYOUT_H
#define GNOMON_SHARED_PATH_LAYOUT_H

#include "build_layout.h"

// A material: reflectance in [0, 1], emitted radiance, roughness and metalness in [0, 1].
typedef struct GnSurface {
  gn_f32 base_color[3];
  gn_f32 roughness;
  gn_f32 emission[3];
  gn_f32 metallic;
} GnSurface;
GN_SIZE_IS(GnSurface, 32);

#define GN_LIGHT_POINT 0u  // and spots
#define GN_LIGHT_SUN 1u
#define GN_LIGHT_AREA 2u
#define GN_LIGHT_SKY 3u

typedef struct GnPathLight {
  gn_f32 position[3];   // point; area: the middle of its surface
  gn_u32 kind;
  gn_f32 direction[3];  // point: the spot's axis; sun: unit, the way light travels
  gn_f32 range;         // point: where it ends, 0: nowhere; area: no point of it is further from `position`
  gn_f32 color[3];      // intensity, irradiance or radiance
  gn_f32 strength;      // what choosing between lights goes by: the colour's luminance, of area lights times the area
  gn_f32 cos_outer;     // point: cosine of the cone's half angle; -2 where it shines all ways
  gn_f32 cone_scale;    // point: over so much of the cosine it rises to full strength, as a reciprocal
  gn_f32 area;
  gn_u32 first;         // area: its triangles are emitters [first, first + count)
  gn_u32 count;
  gn_u32 pad[3];
} GnPathLight;
GN_SIZE_IS(GnPathLight, 80);

// What choosing between lights goes by, a row of numbers for each thing, light after light, so that lanes (lanes.h) read
// side by side. Rows are gn_light_stride() long; what they hold beyond the lights brings nothing. As many as lanes follow the
// last row, for readers that begin at any light.
#define GN_LIGHT_KINDS 0u      // as floats
#define GN_LIGHT_STRENGTHS 1u
#define GN_LIGHT_RANGES 2u
#define GN_LIGHT_CONES 3u      // cos_outer
#define GN_LIGHT_CONE_SCALES 4u
#define GN_LIGHT_POSITIONS 5u  // three rows
#define GN_LIGHT_DIRECTIONS 8u
#define GN_LIGHT_ROWS 11u
#define GN_LIGHT_ROOM 4u       // behind the last row
GN_INLINE gn_u32 gn_light_stride(gn_u32 lights) { return (lights + 3u) / 4u * 4u; }

// A triangle of an area light, and the area of the light up to and with it.
typedef struct GnEmitter {
  gn_u32 triangle;
  gn_f32 running_area;
} GnEmitter;
GN_SIZE_IS(GnEmitter, 8);

// Which light a triangle belongs to; sorted by triangle.
typedef struct GnEmitterLink {
  gn_u32 triangle;
  gn_u32 light;
} GnEmitterLink;
GN_SIZE_IS(GnEmitterLink, 8);

// What light that reaches a surface both ways is weighed by (PathStrategy).
#define GN_STRATEGY_BOTH 0u
#define GN_STRATEGY_LIGHTS 1u
#define GN_STRATEGY_SURFACES 2u

// What all paths share. A picture is walked in tiles of 8 x 8 pixels, row by row, tile after tile; places of a tile
// beyond the picture have no path. Directions through the picture: corner + x right + y down, in pixels from the top
// left.
typedef struct GnPathFrame {
  gn_f32 eye[3];
  gn_u32 width;
  gn_f32 corner[3];
  gn_u32 height;
  gn_f32 right[3];
  gn_u32 tiles_across;
  gn_f32 down[3];
  gn_u32 light_count;
  gn_f32 horizon[3];  // radiance of the sky at, straight above and well below the horizon (y is up)
  gn_f32 offset;      // of rays' origins off a surface
  gn_f32 zenith[3];
  gn_u32 link_count;
  gn_f32 ground[3];
  gn_u32 sky_light;   // the sky's number among the lights; GN_NONE: there is no sky
  gn_u32 seed[2];
  gn_u32 strategy;
  gn_u32 first_roulette;  // the bounce from which on paths may end by chance
} GnPathFrame;
GN_SIZE_IS(GnPathFrame, 128);

// A path under way, and what it has brought so far.
typedef struct GnPath {
  gn_f32 throughput[3];
  gn_f32 density;    // by solid angle, with which its surface sent the ray under way
  gn_f32 radiance[3];
  gn_f32 light_sum;  // of the lights' importances where the ray under way started
  gn_f32 cosine;     // of that ray to the normal there
  gn_u32 pixel;      // GN_NONE: no path
  gn_u32 sample;
  gn_u32 seen;       // whether the camera ray met a surface
} GnPath;
GN_SIZE_IS(GnPath, 48);

// What a shadow ray brings to its path if it is free.
typedef struct GnLit {
  gn_f32 radiance[3];
  gn_u32 light;
} GnLit;
GN_SIZE_IS(GnLit, 16);

#endif
