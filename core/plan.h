// The plan: a scene compiled, once, to the flat, padded, immutable arrays that kernels read, and to the list of stages
// that this scene needs. Kernels see nothing else of the scene. Every index is valid; arrays that vectors gather from
// are padded.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/bvh.h"
#include "core/dimensions.h"
#include "core/environment_map.h"
#include "core/settings.h"
#include "core/stages.h"
#include "core/types.h"

namespace lanewise {

struct Scene;

// A shading normal no further than this from the face's own, on either side, changes no pixel: the surface is flat. A mesh made of
// such has no shading normals.
constexpr float kFlatness = 1.5e-5f;

// What a ray met, as the sort needs it: one bin per shading stage, the materials that take light samples first. kSky:
// missed, where the plan has an environment; kFinished: missed where it has none, absorbed or roulette's.
enum Bin : uint32_t { kDiffuse, kMicrofacet, kRoughGlass, kMirror, kGlass, kEmitter, kSky, kFinished, kBinCount };
constexpr uint32_t kRoughBins = kMirror;     // bins below this one take light samples
constexpr uint32_t kSurfaceBins = kEmitter;  // bins below this one scatter

// One cache line a material, gathered by index.
struct alignas(64) PlanMaterial {
  float reflectance[3];
  float transmittance[3];
  float ior;
  float alpha;
  float eta[3];
  float k[3];
  uint32_t texture;  // index into Plan::textures; 0 where there are none
  uint32_t pad;
};

// Where gathers find a member: float number `member` of the material.
enum MaterialMember : uint32_t {
  kReflectance = 0,
  kTransmittance = 3,
  kIor = 6,
  kAlpha = 7,
  kEta = 8,
  kK = 11,
  kMaterialStride = 16
};

// A texture's texels are Plan::texels[first + y width + x], row 0 at the top.
struct alignas(16) PlanTexture {
  float width, height;
  uint32_t first;
  uint32_t pad;
};
constexpr uint32_t kTextureStride = 4;

// A parallelogram corner + u e1 + v e2 with u, v in [0, 1], or its half with u + v <= 1.
struct alignas(64) LightPatch {
  float corner[3];
  float cdf;  // area of the light's patches up to and with this one, over the light's area
  float e1[3];
  float is_triangle;  // 1 or 0
  float e2[3];
  float pad0;
  float n[3];  // unit normal of the side that emits
  float pad1;
};
enum LightPatchMember : int32_t {
  kCorner = 0,
  kCdf = 3,
  kE1 = 4,
  kIsTriangle = 7,
  kE2 = 8,
  kPatchNormal = 12,
  kLightPatchStride = 16
};

// One emissive mesh (its patches are sampled by area) or one emissive sphere.
struct PlanLight {
  float radiance[3];
  float area;
  float err;  // distance along the normal that puts a shadow ray's end safely off the light
  uint32_t first_patch = 0;
  uint32_t patches = 0;  // 0: a sphere
  float center[3] = {0, 0, 0};
  float radius = 0;
};

// A mirror or glass sphere by way of which lights are sampled: see core/plan_connections.h.
struct ConnectedSphere {
  float center[3] = {0, 0, 0};
  float radius = 0;
  float err = 0;  // distance along the normal that puts a ray's end safely off it
  float ior = 0;  // of glass; 0: a mirror
  float reflectance[3] = {0, 0, 0};
  float importance = 0;  // a vertex at distance r chooses it with a chance that goes with importance (radius / r)^2
};

// A sphere around surfaces that are not diffuse: light paths aim at them.
struct Caster {
  float center[3] = {0, 0, 0};
  float radius = 0;
};

// How a lamp sends out its light paths. They start with beta = its radiance over the largest channel of that, times `throughput`, the
// cosine at the lamp and the solid angle of all cones over the number that the direction lies in: about 1.
struct LampPaths {
  uint32_t per_pass = 0;  // a pass goes with every sample of the pixels
  float throughput = 0;   // per steradian
  float scale = 0;        // power that beta = 1 stands for, over a pass's paths: radiance, area, solid angle
};

// A triangle or sphere outside the trees, tested by whole vectors of rays.
struct FlatTriangle {
  float v[3][3];  // vertex, axis
  uint32_t prim;
};
struct FlatSphere {
  float center[3];
  float radius;
  uint32_t prim;
};

// A parallelogram outside the trees. A point q of its plane is on it where |a.q + a_0| <= 1 + a_margin and the same for
// b. The margins, some rounding errors wide, make quads that share an edge overlap there rather than leave a gap
// between them; the picture sees quads that are larger by some millionths of the scene.
struct FlatQuad {
  float n[3];      // unit normal
  float distance;  // n.p of its points
  float a[3];
  float a_0;
  float b[3];
  float b_0;
  float a_margin;
  float b_margin;
  float reach;    // the largest |x| + |y| + |z| of its corners and of the camera
  uint32_t prim;  // the first of its two triangles; the second's index is not used
};

// Two opposite quads, one a translate of the other up to the rounding errors of a quad's test (the second then takes over
// the first's normal and forms), with all geometry and the camera between their planes.
// Every ray starts there, so it can only meet the one that it travels towards: the two cost what one does. Which hits
// there are, where and of which primitive is what the two quads would say for any origin between their planes.
struct FlatSlab {
  float n[3];         // unit normal
  float distance[2];  // n.p of the lower face, met by rays with n.d < 0, and of the upper one
  float a[3];
  float a_0;
  float b[3];
  float b_0;
  float a_margin;
  float b_margin;
  uint32_t prim[2];
};

// kLeafWidth triangles or spheres side by side, tested by one ray. Short blocks repeat their first.
struct alignas(64) TriangleBlock {
  float v[3][3][kLeafWidth];  // vertex, axis, lane
  uint32_t prim[kLeafWidth];
};
struct alignas(64) SphereBlock {
  float center[3][kLeafWidth];
  float radius[kLeafWidth];
  uint32_t prim[kLeafWidth];
};

// Large meshes go into a tree; a few large triangles are cheaper tested all.
constexpr uint32_t kMaxFlatTriangles = 32;
constexpr uint32_t kMaxFlatMesh = 16;  // triangles of a mesh that may go into the flat list
constexpr uint32_t kMaxFlatSpheres = 16;

struct PlanCamera {
  float eye[3];      // relative to the plan's centre
  float forward[3];  // orthonormal
  float right[3];
  float up[3];
  float pixel;        // a pixel's side at distance 1 (square pixels): 1 / focal length in pixels
  float lens_radius;  // 0: a pinhole
  float lens_angle;   // lens_radius / focal distance
};

// A material's part in a bounce: `light` weighs the light sample at every vertex, `shade` scatters the path.
struct ShadeStages {
  Bin bin;
  Stage light;  // Stage::kCount for delta materials, which take no light samples
  Stage shade;
};

// A mesh's triangles or all spheres: primitives first .. first + size - 1, and where rays look for them.
struct PlanGroup {
  std::string name;
  uint32_t first = 0;
  uint32_t size = 0;
  bool flat = false;    // in the flat lists, otherwise in a tree
  bool smooth = false;  // some shading normal is not its face's
};

struct Plan {
  Settings settings;
  double center[3] = {0, 0, 0};  // scene position = plan position + center
  PlanCamera camera;

  // Primitives 0 .. triangles - 1 are triangles, then come the spheres. Bytes a triangle: 32 in the arrays below, 36 more
  // with shading normals, and some 60 in the tree (see tests/bvh_test.cc): nodes 7, blocks 53, which are six of eight full.
  uint32_t triangles = 0;
  uint32_t spheres = 0;
  AlignedVector<float>
      prim_shape;                 // 4 a primitive: triangle: unit normal n and n.p of its plane; sphere: center, radius
  AlignedVector<float> prim_err;  // distance that keeps a ray's origin safely off it: see ray_offset.h
  AlignedVector<float> prim_normals;      // 9 a triangle: unit shading normals of its corners; empty: all are flat
  AlignedVector<uint32_t> prim_material;  // index into materials
  AlignedVector<uint32_t> prim_bin;       // Bin
  AlignedVector<uint32_t> prim_light;     // index into lights; 0 for what is no emitter
  AlignedVector<PlanMaterial> materials;
  AlignedVector<PlanTexture> textures;  // the first is white, for surfaces without one; empty: no surface has one
  AlignedVector<uint32_t> texels;       // as Texture has them
  AlignedVector<float>
      prim_texture;  // 8 a primitive: a, a_0, b, b_0: its point p is at column a.p + a_0, row b.p + b_0 of
                     // its texture, with texel (x, y) centred on (x, y); empty as textures
  AlignedVector<LightPatch> light_patches;
  std::vector<PlanLight> lights;
  AlignedVector<float> light_table;                // 4 a light, to gather by light: radiance, area
  std::vector<ConnectedSphere> connected_spheres;  // all mirrors and glasses among the spheres, or none
  std::vector<Caster> casters;                     // empty: there are no light paths
  float shown = 1;                                 // what drop_unseen_light_paths has found
  std::vector<LampPaths> lamp_paths;               // of each of the lights; empty as casters
  EnvironmentMap environment;                      // around the scene; empty: black

  // Where rays look for them: every primitive is in exactly one of quads, triangles, spheres and the two trees. Of quads and triangles the first are
  // those that can block light between two points of the scene: one with all geometry on one side of its plane cannot, but from
  // the sky, so that with an environment these are all.
  // The last quads, from single_quads on, are the faces of slabs, which stand for them where the closest hit is wanted.
  std::vector<FlatQuad> flat_quads;
  uint32_t single_quads = 0;
  std::vector<FlatSlab> flat_slabs;
  std::vector<FlatTriangle> flat_triangles;
  uint32_t blocking_quads = 0;
  uint32_t blocking_triangles = 0;
  std::vector<FlatSphere> flat_spheres;
  Bvh triangle_tree;
  AlignedVector<TriangleBlock> triangle_blocks;
  Bvh sphere_tree;
  AlignedVector<SphereBlock> sphere_blocks;

  std::vector<ShadeStages> shade_stages;  // only those that the scene needs, in bin order
  std::vector<PlanGroup> groups;          // every primitive is in one
};

// Lights that are sampled at a vertex, each by itself: those of the scene, then, as light number lights.size(), the environment.
inline uint32_t sampled_lights(const Plan& plan) {
  return static_cast<uint32_t>(plan.lights.size()) + !plan.environment.empty();
}
inline bool is_environment(const Plan& plan, uint32_t light) { return light == plan.lights.size(); }

// The set of random numbers of the sample of a light: see core/dimensions.h.
inline uint32_t light_set(const Plan& plan, const Step& step) {
  return kSetLight + step.light * plan.settings.light_samples + step.light_sample;
}

// Compiles the scene for these settings. Throws Error for what a plan cannot hold (2^29 primitives or more).
Plan make_plan(const Scene& scene, const Settings& settings);

// The same; gives back the memory of the scene's meshes as it goes.
Plan make_plan(Scene&& scene, const Settings& settings);

}  // namespace lanewise
