#include "core/plan_trees.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lanewise {
namespace {

Box box_of(const FlatTriangle& t) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lo[axis] = std::min({t.v[0][axis], t.v[1][axis], t.v[2][axis]});
    box.hi[axis] = std::max({t.v[0][axis], t.v[1][axis], t.v[2][axis]});
  }
  return box;
}

Box box_of(const FlatSphere& s) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lo[axis] = std::nextafter(s.center[axis] - s.radius, -INFINITY);
    box.hi[axis] = std::nextafter(s.center[axis] + s.radius, INFINITY);
  }
  return box;
}

void pack(const FlatTriangle& t, TriangleBlock& block, size_t lane) {
  for (int corner = 0; corner < 3; ++corner) {
    for (int axis = 0; axis < 3; ++axis) block.v[corner][axis][lane] = t.v[corner][axis];
  }
}

void pack(const FlatSphere& s, SphereBlock& block, size_t lane) {
  for (int axis = 0; axis < 3; ++axis) block.center[axis][lane] = s.center[axis];
  block.radius[lane] = s.radius;
}

template <class Primitive, class Block>
void plant(std::span<const Primitive> primitives, Bvh& tree, AlignedVector<Block>& blocks) {
  std::vector<Box> boxes(primitives.size());
  tbb::parallel_for(size_t{0}, primitives.size(), [&](size_t i) { boxes[i] = box_of(primitives[i]); });
  tree = build_bvh(std::move(boxes));
  blocks.resize(tree.leaf_prims.size() / kLeafWidth);
  tbb::parallel_for(size_t{0}, blocks.size(), [&](size_t b) {
    const uint32_t* prims = &tree.leaf_prims[b * kLeafWidth];
    for (size_t lane = 0; lane < kLeafWidth; ++lane) {
      // Short blocks repeat their first primitive.
      const Primitive& primitive = primitives[prims[lane] == kNoPrim ? prims[0] : prims[lane]];
      blocks[b].prim[lane] = primitive.prim;
      pack(primitive, blocks[b], lane);
    }
  });
  tree.leaf_prims = std::vector<uint32_t>();
}

}  // namespace

void plant_triangles(Plan& plan, std::span<const FlatTriangle> triangles) {
  plant(triangles, plan.triangle_tree, plan.triangle_blocks);
}

void plant_spheres(Plan& plan, std::span<const FlatSphere> spheres) {
  plant(spheres, plan.sphere_tree, plan.sphere_blocks);
}

}  // namespace lanewise
