#include "core/plan_trees.h"

#include <algorithm>
#include <cmath>

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
  std::vector<Box> boxes;
  boxes.reserve(primitives.size());
  for (const Primitive& p : primitives) boxes.push_back(box_of(p));
  tree = build_bvh(boxes);
  blocks.assign(tree.leaf_prims.size() / kLeafWidth, Block{});
  for (size_t i = 0; i < tree.leaf_prims.size(); ++i) {
    Block& block = blocks[i / kLeafWidth];
    const size_t lane = i % kLeafWidth;
    // Short blocks repeat their first primitive.
    uint32_t index = tree.leaf_prims[i];
    if (index == kNoPrim) index = tree.leaf_prims[i - lane];
    block.prim[lane] = primitives[index].prim;
    pack(primitives[index], block, lane);
  }
}

}  // namespace

void plant_triangles(Plan& plan, std::span<const FlatTriangle> triangles) {
  plant(triangles, plan.triangle_tree, plan.triangle_blocks);
}

void plant_spheres(Plan& plan, std::span<const FlatSphere> spheres) {
  plant(spheres, plan.sphere_tree, plan.sphere_blocks);
}

}  // namespace lanewise
