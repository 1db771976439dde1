#include "core/bvh.h"

#include <doctest/doctest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <span>

#include "core/plan.h"
#include "core/scene.h"
#include "scenes/builtin.h"

namespace lanewise {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

bool contains(const Box& outer, const Box& inner) {
  for (int a = 0; a < 3; ++a) {
    if (!(outer.lo[a] <= inner.lo[a] && inner.hi[a] <= outer.hi[a])) return false;
  }
  return true;
}

struct Walker {
  std::span<const Box> boxes;
  const Bvh& bvh;
  std::vector<int> prim_seen, node_seen;
  uint32_t wrong = 0;
  uint32_t depth = 0;

  // Checks the subtree of a child against the box that its parent has for it.
  void check(uint32_t child, const Box& box, uint32_t level) {
    if (child & kLeafBit) {
      const size_t first = size_t{leaf_block(child)} * kLeafWidth;
      for (size_t i = first; i < first + kLeafWidth; ++i) {
        const uint32_t prim = bvh.leaf_prims.at(i);
        if (prim == kNoPrim) continue;
        ++prim_seen.at(prim);
        wrong += !contains(box, boxes[prim]);
      }
      return;
    }
    depth = std::max(depth, level + 1);
    ++node_seen.at(child);
    const BvhNode& node = bvh.nodes.at(child);
    for (size_t i = 0; i < kBvhWidth; ++i) {
      Box inner;
      for (size_t a = 0; a < 3; ++a) {
        inner.lo[a] = node.lo[a][i];
        inner.hi[a] = node.hi[a][i];
      }
      if (inner.lo[0] > inner.hi[0]) {
        for (size_t a = 0; a < 3; ++a) wrong += !(inner.lo[a] == kInf && inner.hi[a] == -kInf);
        continue;
      }
      wrong += !contains(box, inner);
      check(node.child[i], inner, level + 1);
    }
  }
};

Bvh check_tree(const std::vector<Box>& boxes) {
  const Bvh bvh = build_bvh(boxes);
  Walker walker{boxes, bvh, std::vector<int>(boxes.size()), std::vector<int>(bvh.nodes.size())};
  REQUIRE(!bvh.nodes.empty());
  walker.check(0, bvh.bounds, 0);
  CHECK(walker.wrong == 0);
  CHECK(walker.depth == bvh.depth);
  CHECK(bvh.depth <= kMaxBvhDepth);
  CHECK(std::count(walker.prim_seen.begin(), walker.prim_seen.end(), 1) == static_cast<long>(boxes.size()));
  CHECK(std::count(walker.node_seen.begin(), walker.node_seen.end(), 1) == static_cast<long>(bvh.nodes.size()));
  return bvh;
}

std::vector<Box> random_boxes(size_t n, float spread, float size) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Box> boxes(n);
  for (Box& box : boxes) {
    for (int a = 0; a < 3; ++a) {
      box.lo[a] = spread * (unit(rng) - 0.5f);
      box.hi[a] = box.lo[a] + size * unit(rng);
    }
  }
  return boxes;
}

// Of all pairs of children of a node, the share whose centres a diagonal ray of each octant passes in the order in which
// it visits slots: octant ^ 0, octant ^ 1, ...
double ordered_share(const Bvh& bvh) {
  double pairs = 0, ordered = 0;
  for (const BvhNode& node : bvh.nodes) {
    for (uint32_t octant = 0; octant < 8; ++octant) {
      const auto middle = [&](uint32_t slot) {
        float sum = 0;
        for (int a = 0; a < 3; ++a) sum += (octant >> a & 1 ? -1 : 1) * (node.lo[a][slot] + node.hi[a][slot]);
        return sum;
      };
      for (uint32_t i = 0; i < kBvhWidth; ++i) {
        for (uint32_t j = i + 1; j < kBvhWidth; ++j) {
          if (node.lo[0][i ^ octant] > node.hi[0][i ^ octant] || node.lo[0][j ^ octant] > node.hi[0][j ^ octant])
            continue;
          ++pairs;
          ordered += middle(i ^ octant) <= middle(j ^ octant);
        }
      }
    }
  }
  return ordered / pairs;
}

// Expected nodes entered and leaves tested by a ray that enters the root's box, if rays are everywhere alike.
double sah_cost(const Bvh& bvh) {
  const auto area = [](double x, double y, double z) { return x * y + y * z + z * x; };
  double sum = 0;
  for (const BvhNode& node : bvh.nodes) {
    for (size_t i = 0; i < kBvhWidth; ++i) {
      if (node.lo[0][i] > node.hi[0][i]) continue;
      sum += area(node.hi[0][i] - node.lo[0][i], node.hi[1][i] - node.lo[1][i], node.hi[2][i] - node.lo[2][i]);
    }
  }
  const Box& b = bvh.bounds;
  return 1 + sum / area(b.hi[0] - b.lo[0], b.hi[1] - b.lo[1], b.hi[2] - b.lo[2]);
}

// Of the triangles of all meshes of at least so many.
std::vector<Box> boxes_of(const Scene& scene, size_t least) {
  std::vector<Box> boxes;
  for (const Mesh& mesh : scene.meshes) {
    for (const auto& triangle : mesh.triangles) {
      if (mesh.triangles.size() < least) continue;
      Box box{{kInf, kInf, kInf}, {-kInf, -kInf, -kInf}};
      for (const uint32_t v : triangle) {
        for (int a = 0; a < 3; ++a) {
          box.lo[a] = std::min(box.lo[a], static_cast<float>(mesh.positions[v][a]));
          box.hi[a] = std::max(box.hi[a], static_cast<float>(mesh.positions[v][a]));
        }
      }
      boxes.push_back(box);
    }
  }
  return boxes;
}

Box point(float x, float y, float z) { return {{x, y, z}, {x, y, z}}; }

}  // namespace

TEST_CASE("bvh: nothing gives an empty tree") {
  const Bvh bvh = build_bvh({});
  CHECK(bvh.nodes.empty());
  CHECK(bvh.leaf_prims.empty());
}

TEST_CASE("bvh: every primitive once, boxes within their parents' boxes") {
  for (const size_t n : {1, 2, 3, 4, 5, 8, 9, 17, 100, 5000}) check_tree(random_boxes(n, 1, 0.1f));
  check_tree(random_boxes(100000, 1, 0.01f));
  check_tree(random_boxes(1000, 1, 10));
}

TEST_CASE("bvh: slots in the order of a ray's octant are mostly front to back") {
  CHECK(ordered_share(build_bvh(random_boxes(20000, 1, 0.02f))) > 0.8);
}

TEST_CASE("bvh: cost of a mesh, and of a mesh in a room") {
  // 12.3 and 6.4 before the collapse at least cost and reinsertion.
  const Scene scene = load_builtin("builtin:dense:10000");
  CHECK(sah_cost(build_bvh(boxes_of(scene, 1000))) < 11.4);
  CHECK(sah_cost(build_bvh(boxes_of(scene, 0))) < 5.8);
}

TEST_CASE("bvh: bytes a triangle") {
  const std::vector<Box> boxes = boxes_of(load_builtin("builtin:dense:10000"), 0);
  const Bvh bvh = build_bvh(boxes);
  const size_t blocks = bvh.leaf_prims.size() / kLeafWidth;
  CHECK(bvh.nodes.size() * sizeof(BvhNode) < 8 * boxes.size());
  CHECK(blocks * sizeof(TriangleBlock) < 56 * boxes.size());
}

TEST_CASE("bvh: degenerate boxes") {
  SUBCASE("identical") { check_tree(std::vector<Box>(1000, Box{{1, 2, 3}, {4, 5, 6}})); }
  SUBCASE("identical points") { check_tree(std::vector<Box>(1000, point(1, 2, 3))); }
  SUBCASE("in a plane") {
    std::vector<Box> boxes = random_boxes(1000, 1, 0.1f);
    for (Box& box : boxes) box.lo[1] = box.hi[1] = 0.25f;
    check_tree(boxes);
  }
  SUBCASE("each many times") {
    std::vector<Box> boxes;
    for (int i = 0; i < 2000; ++i) boxes.push_back(point(static_cast<float>(i % 3), 0, 0));
    check_tree(boxes);
  }
  SUBCASE("sizes and places over the whole range of floats") {
    std::vector<Box> boxes;
    for (int i = 0; i < 20000; ++i) {
      const float x = std::ldexp(1.0f, i % 240 - 140);
      boxes.push_back({{x, -x, 0}, {1.5f * x, x, x}});
    }
    check_tree(boxes);
  }
  SUBCASE("areas that overflow") { check_tree(random_boxes(1000, 1e38f, 1e37f)); }
}

TEST_CASE("bvh: the same tree whatever the number of threads") {
  const std::vector<Box> boxes = random_boxes(150000, 1, 0.02f);
  const Bvh many = build_bvh(boxes);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Bvh few = build_bvh(boxes);
  REQUIRE(many.nodes.size() == few.nodes.size());
  CHECK(many.leaf_prims == few.leaf_prims);
  CHECK(std::memcmp(many.nodes.data(), few.nodes.data(), few.nodes.size() * sizeof(BvhNode)) == 0);
}

}  // namespace lanewise
