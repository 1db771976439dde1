#include <algorithm>
#include <string>

#include "core/explain_topics.h"

namespace lanewise {
namespace {

constexpr size_t kMostTreeRows = 8;  // more meshes in trees than that share one

uint32_t count_faces(const PlanGroup& group, const std::vector<FlatQuad>& faces, size_t end, size_t begin = 0) {
  return static_cast<uint32_t>(std::count_if(faces.begin() + static_cast<ptrdiff_t>(begin),
                                             faces.begin() + static_cast<ptrdiff_t>(end),
                                             [&](const FlatQuad& f) { return f.prim - group.first < group.size; }));
}

uint32_t count_faces(const PlanGroup& group, const std::vector<FlatTriangle>& faces, size_t end) {
  return static_cast<uint32_t>(std::count_if(faces.begin(), faces.begin() + static_cast<ptrdiff_t>(end),
                                             [&](const FlatTriangle& f) { return f.prim - group.first < group.size; }));
}

std::string why_tree(const Plan& plan, const PlanGroup& group, bool spheres) {
  if (plan.settings.accel == Accel::kTree) return "--accel tree";
  if (spheres) return "more than " + count_of(kMaxFlatSpheres, "sphere");
  if (group.size > kMaxFlatMesh) return "more than " + count_of(kMaxFlatMesh, "triangle");
  return "the list's " + count_of(kMaxFlatTriangles, "triangle") + " are used up by smaller meshes";
}

Decision explain_flat(const Plan& plan, const PlanGroup& group) {
  const uint32_t quads = count_faces(group, plan.flat_quads, plan.flat_quads.size());
  const uint32_t triangles = count_faces(group, plan.flat_triangles, plan.flat_triangles.size());
  const uint32_t blocking = count_faces(group, plan.flat_quads, plan.blocking_quads) +
                            count_faces(group, plan.flat_triangles, plan.blocking_triangles);
  std::string reason = blocking == 0                   ? "all geometry on one side: blocks no light"
                       : blocking == quads + triangles ? ""
                                                       : "the others have all geometry on one side";
  if (group.smooth) reason += (reason.empty() ? "" : "; ") + std::string("interpolated normals: no parallelograms");
  const uint32_t paired = count_faces(group, plan.flat_quads, plan.flat_quads.size(), plan.single_quads);
  if (paired > 0) reason += std::string(reason.empty() ? "" : "; ") + "one test with the wall opposite";
  if (reason.empty()) reason = "few: all tested, by whole vectors of rays";
  return {"geometry",
          group.name,
          "flat list",
          reason,
          {{"triangles", double{1} * group.size},
           {"parallelograms", double{1} * quads},
           {"faces_tested", double{1} * (quads + triangles)},
           {"in_slabs", double{1} * paired},
           {"for_shadows", double{1} * blocking}}};
}

// The surface-area heuristic of a whole tree: what a ray that meets its bounds, uniform over directions and places, is
// expected to visit.
struct Visits {
  double nodes = 0, blocks = 0;
};
Visits expected_visits(const Bvh& tree) {
  const auto area = [](const auto& box_lo, const auto& box_hi) {
    const double x = box_hi(0) - box_lo(0), y = box_hi(1) - box_lo(1), z = box_hi(2) - box_lo(2);
    return x * y + y * z + z * x;
  };
  const double all =
      area([&](int a) { return double{tree.bounds.lo[a]}; }, [&](int a) { return double{tree.bounds.hi[a]}; });
  Visits visits{1, 0};
  if (!(all > 0)) return visits;
  for (const BvhNode& node : tree.nodes) {
    for (uint32_t k = 0; k < kBvhWidth; ++k) {
      if (node.lo[0][k] > node.hi[0][k]) continue;
      const double share =
          area([&](int a) { return double{node.lo[a][k]}; }, [&](int a) { return double{node.hi[a][k]}; }) / all;
      (node.child[k] & kLeafBit ? visits.blocks : visits.nodes) += share;
    }
  }
  return visits;
}

template <class Block>
void explain_tree(const char* subject, const Bvh& tree, const AlignedVector<Block>& blocks,
                  std::vector<Decision>& out) {
  if (tree.nodes.empty()) return;
  uint64_t primitives = 0;
  for (const Block& block : blocks) primitives += block_size(block);
  const Visits visits = expected_visits(tree);
  const double lanes = static_cast<double>(blocks.size() * kLeafWidth);
  out.push_back({"trees",
                 subject,
                 std::to_string(kBvhWidth) + " wide",
                 "for rays that meet its bounds; visits expected by SAH",
                 {{"primitives", static_cast<double>(primitives)},
                  {"nodes", static_cast<double>(tree.nodes.size())},
                  {"depth", double{1} * tree.depth},
                  {"leaf_blocks", static_cast<double>(blocks.size())},
                  {"fill", static_cast<double>(primitives) / lanes, FigureUnit::kShare},
                  {"node_visits", visits.nodes},
                  {"block_visits", visits.blocks},
                  {"bytes", static_cast<double>(sizeof(BvhNode) * tree.nodes.size() + sizeof(Block) * blocks.size()),
                   FigureUnit::kBytes}}});
}

}  // namespace

void explain_geometry(const Plan& plan, std::vector<Decision>& out) {
  PlanGroup merged;  // of the meshes in the tree, if they are many
  uint64_t trees = 0;
  for (const PlanGroup& group : plan.groups) {
    if (group.flat || group.first >= plan.triangles) continue;
    ++trees;
    merged.size += group.size;
  }
  const bool merge = trees > kMostTreeRows;
  for (const PlanGroup& group : plan.groups) {
    const bool spheres = group.first >= plan.triangles;
    if (spheres && group.flat) {
      out.push_back({"geometry",
                     group.name,
                     "flat list",
                     "few: all tested, by whole vectors of rays",
                     {{"spheres", double{1} * group.size}}});
    } else if (group.flat) {
      out.push_back(explain_flat(plan, group));
    } else if (spheres || !merge) {
      out.push_back({"geometry",
                     group.name,
                     "tree",
                     why_tree(plan, group, spheres),
                     {{spheres ? "spheres" : "triangles", double{1} * group.size}}});
    }
  }
  if (merge) {
    out.push_back({"geometry",
                   count_of(trees, "mesh") + "es",
                   "tree",
                   plan.settings.accel == Accel::kTree ? "--accel tree" : "too many triangles for the flat list",
                   {{"triangles", double{1} * merged.size}}});
  }
  explain_tree("triangles", plan.triangle_tree, plan.triangle_blocks, out);
  explain_tree("spheres", plan.sphere_tree, plan.sphere_blocks, out);
  if (plan.triangle_tree.nodes.empty() && plan.sphere_tree.nodes.empty()) {
    out.push_back({"trees", "none", "not built", "all geometry is in the flat lists", {}});
  }
}

}  // namespace lanewise
