// THE field list: everything a path carries, once. From it come the SoA pointers, their allocation, the AoS Path<T> of
// the scalar twins, the move in the sort, and the fill, comparison and dump in tests. Adding a field is adding a line.
#pragma once

#include <cstdint>
#include <type_traits>

#include "core/types.h"

namespace lanewise {

// KEPT fields live across the sort and are moved by it; LOCAL fields live only between two sorts, or (bin) end in one.
// All are 4 bytes wide. Lengths are in scene units relative to the plan's centre; directions are unit vectors unless
// said otherwise; radiance and throughput are linear RGB. "Surface" below is the hit after the kernel `surface` has
// run.
// The first kRetiredFields are all that a finished path still needs.
//
//   KEPT(type, name, meaning)
#define LANEWISE_PATH_FIELDS(KEPT, LOCAL)                                                                \
  KEPT(uint32_t, slot, "the path's place in the wave at generate; where retire puts its radiance")       \
  KEPT(float, L_r, "radiance gathered so far")                                                           \
  KEPT(float, L_g, "")                                                                                   \
  KEPT(float, L_b, "")                                                                                   \
  KEPT(uint32_t, pixel, "y * width + x, row 0 at the top")                                               \
  KEPT(uint32_t, sample, "index of the sample within its pixel, modulo 2^32: see Step::epoch")           \
  KEPT(float, o_x, "ray origin, offset off the surface it leaves; surface: the hit point itself")        \
  KEPT(float, o_y, "")                                                                                   \
  KEPT(float, o_z, "")                                                                                   \
  KEPT(float, d_x, "unit direction of travel, away from the camera; wo = -d at the surface")             \
  KEPT(float, d_y, "")                                                                                   \
  KEPT(float, d_z, "")                                                                                   \
  KEPT(float, beta_r, "throughput: product of f cos / pdf so far; 0 ends the path")                      \
  KEPT(float, beta_g, "")                                                                                \
  KEPT(float, beta_b, "")                                                                                \
  KEPT(float, pdf, "density of d per steradian when last scattered; 0: camera, delta; or kConnected")    \
  KEPT(uint32_t, lamps, "LampsBy: who brings the light of lamps that are met, or sampled, next")         \
  KEPT(uint32_t, prim, "primitive hit, or kNoPrim")                                                      \
  KEPT(float, t, "distance to the hit, +inf for none")                                                   \
  KEPT(float, u, "barycentric weight of a triangle's second vertex at the hit (0 for spheres)")          \
  KEPT(float, v, "barycentric weight of its third vertex")                                               \
  LOCAL(uint32_t, bin, "Bin of the hit, written by intersect, read by the sort")                         \
  LOCAL(float, n_x, "unit geometric normal as the surface's winding gives it, not turned to the viewer") \
  LOCAL(float, n_y, "")                                                                                  \
  LOCAL(float, n_z, "")                                                                                  \
  LOCAL(float, s_x, "unit shading normal, on the side of n's winding")                                   \
  LOCAL(float, s_y, "")                                                                                  \
  LOCAL(float, s_z, "")                                                                                  \
  LOCAL(float, err, "distance along n that puts a ray origin safely off the surface")                    \
  LOCAL(float, l_x, "shadow ray: from the offset hit point to the offset light point, not normalised")   \
  LOCAL(float, l_y, "")                                                                                  \
  LOCAL(float, l_z, "")                                                                                  \
  LOCAL(float, l_pdf, "density of the light sample's direction per steradian; 0: no usable sample")      \
  LOCAL(float, m_x, "connection: shadow ray on from where l ends, to the offset light point")            \
  LOCAL(float, m_y, "")                                                                                  \
  LOCAL(float, m_z, "")                                                                                  \
  LOCAL(uint32_t, via, "connection: by way of which of Plan::connected_spheres")                         \
  LOCAL(float, c_r, "radiance that the light sample adds to L if it is seen; not yet what via reflects") \
  LOCAL(float, c_g, "")                                                                                  \
  LOCAL(float, c_b, "")                                                                                  \
  LOCAL(uint32_t, raster, "light path: the pixel in which the camera sees the vertex")                   \
  LOCAL(float, a_r, "albedo of a diffuse surface, where the scene has textures")                         \
  LOCAL(float, a_g, "")                                                                                  \
  LOCAL(float, a_b, "")

constexpr int kRetiredFields = 4;  // slot and L

// In place of pdf after the delta lobe of a sphere by way of which the vertex before has been connected to the lights: what
// light is met next has been counted there.
constexpr float kConnected = -1;

// Where there are light paths, they bring what lamps (lights other than the environment) send to a diffuse surface that the camera
// sees, at once or by way of further surfaces of any kind, through a first one that is not diffuse: see core/plan_light_paths.h.
// Which path from the camera looks for lamps:
enum LampsBy : uint32_t {
  kByItself,  // this one does: the camera sees a surface that is not diffuse, or a direction did not agree with a surface's normals
  kByItselfYet,   // this one does: the camera sees a diffuse surface, and the path is at one
  kByLightPaths,  // light paths do: the camera sees a diffuse surface, and the path is at another
};

// What all paths of a wave share at one moment.
struct Step {
  uint32_t bounce = 0;        // scattering events behind every live path
  uint32_t light = 0;         // the light that sample_light samples
  uint32_t light_sample = 0;  // which of the plan's samples of that light
  bool connection = false;    // by way of a sphere: see core/plan_connections.h
  uint64_t epoch = 0;         // epoch_of() their samples: 0 for a pixel's first 2^32; or light_path_epoch()
  bool from_light = false;    // these are light paths
  bool diffuse = false;       // take_lamps: at diffuse surfaces
  bool leaving = false;       // take_lamps, adjoint: d leaves the vertex
  uint32_t partner = 0;       // connect_paths: slot i's path with the first vertex of slot i ^ partner's
};

// In a list of pixels: none.
constexpr uint32_t kNoPixel = 0xffffffff;

// The samples that a wave computes: those with the same number of so many pixels in turn, the group, are neighbours. Its path i is
// sample first_sample + j / group % samples of pixel pixels[j / (samples group) group + j % group], with j = first_path + i.
struct Batch {
  const uint32_t* pixels = nullptr;  // whole groups; kNoPixel: the group is smaller
  const uint32_t* slots = nullptr;   // pixel j's sums are film[slots[j]], kNoPixel: nobody's; null: film[pixels[j]]
  uint32_t group = 1;                // 1 or kPathsTogether; first_path and paths are multiples of it
  uint32_t samples = 0;              // per pixel, > 0
  uint64_t first_sample = 0;        // the samples do not reach over a multiple of 2^32
  uint64_t first_path = 0;
  uint32_t paths = 0;  // at most the wave's size
};

// Of paths that are used again (core/path_reuse.h): what is kept of two of their vertices, by slot, capacity + kLanes elements
// each; null where none are. bounce says whether there is a first one, gain > 0 whether there is a second.
//   X(name, meaning)
#define LANEWISE_KEPT_FIELDS(X)                                                 \
  X(x_x, "first vertex: ray origin, offset off the surface")                    \
  X(x_y, "")                                                                    \
  X(x_z, "")                                                                    \
  X(n_x, "its unit normal, on the side of x")                                   \
  X(n_y, "")                                                                    \
  X(n_z, "")                                                                    \
  X(f_r, "throughput behind it")                                                \
  X(f_g, "")                                                                    \
  X(f_b, "")                                                                    \
  X(y_x, "second vertex: point offset off the surface, on the side of x")       \
  X(y_y, "")                                                                    \
  X(y_z, "")                                                                    \
  X(m_x, "its unit normal, on the side of y")                                   \
  X(m_y, "")                                                                    \
  X(m_z, "")                                                                    \
  X(L_r, "radiance that the path gathered before it")                           \
  X(L_g, "")                                                                    \
  X(L_b, "")                                                                    \
  X(gain, "makes radiance at y, towards x, of what it has gathered since then") \
  X(bounce, "of y if x is kept; 0: no diffuse surface yet; negative: its first one is not to be shared")

#define LANEWISE_COUNT(name, meaning) +1
constexpr uint32_t kKeptFields = 0 LANEWISE_KEPT_FIELDS(LANEWISE_COUNT);
#undef LANEWISE_COUNT

struct KeptVertices {
#define LANEWISE_POINTER(name, meaning) float* name = nullptr;
  LANEWISE_KEPT_FIELDS(LANEWISE_POINTER)
#undef LANEWISE_POINTER
};

// SoA view of a wave's paths: one 64-byte aligned array a field, of capacity + 2 * kLanes * kBinCount elements at
// least. Padding slots hold the dummy path: throughput 0, finite values everywhere, unit directions, prim 0, and a slot
// of its own (the capacity) to retire to, so that kernels compute on it without harm or mask.
struct PathState {
#define LANEWISE_POINTER(type, name, meaning) type* name = nullptr;
  LANEWISE_PATH_FIELDS(LANEWISE_POINTER, LANEWISE_POINTER)
#undef LANEWISE_POINTER

  uint32_t capacity = 0;  // the wave's size; also the slot of padding
  Step step;
  Batch batch;

  // Radiance of retired paths by slot, capacity + kLanes elements each.
  float* result_r = nullptr;
  float* result_g = nullptr;
  float* result_b = nullptr;

  KeptVertices kept;
};

// A field's type in Path<T>: floats become T, integers stay.
template <class T, class Field>
using PathField = std::conditional_t<std::is_same_v<Field, float>, T, Field>;

// The AoS form, for the scalar twins: T is float (the scalar renderer, benchmarks) or double (what kernels are held against).
template <class T>
struct Path {
#define LANEWISE_MEMBER(type, name, meaning) PathField<T, type> name{};
  LANEWISE_PATH_FIELDS(LANEWISE_MEMBER, LANEWISE_MEMBER)
#undef LANEWISE_MEMBER

  Step step;
};

// The harmless path that fills padding: see PathState.
inline Path<float> dummy_path(uint32_t capacity) {
  Path<float> p;
  p.slot = capacity;
  p.d_z = 1;
  p.t = 1;
  p.n_z = p.s_z = 1;
  p.l_z = 1;
  return p;
}

// Path<T> from and to slot i of the arrays.
template <class T>
Path<T> load_path(const PathState& s, uint32_t i) {
  Path<T> p;
#define LANEWISE_LOAD(type, name, meaning) p.name = static_cast<decltype(p.name)>(s.name[i]);
  LANEWISE_PATH_FIELDS(LANEWISE_LOAD, LANEWISE_LOAD)
#undef LANEWISE_LOAD
  p.step = s.step;
  return p;
}

template <class T>
void store_path(const PathState& s, uint32_t i, const Path<T>& p) {
#define LANEWISE_STORE(type, name, meaning) s.name[i] = static_cast<type>(p.name);
  LANEWISE_PATH_FIELDS(LANEWISE_STORE, LANEWISE_STORE)
#undef LANEWISE_STORE
}

}  // namespace lanewise
