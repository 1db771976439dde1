// Bittner, Hapala & Havran, Fast Insertion-Based Optimization of Bounding Volume Hierarchies, CGF 32(1), 2013: subtrees
// are taken out and put back where they make the tree's area grow least.
#include <tuple>
#include <vector>

#include "core/bvh_binary.h"

namespace lanewise::bvh {
namespace {

// Of the nodes of largest area, at the top: where large and small primitives meet there is most to gain, and the time
// does not grow with the tree. Further down splits by SAH leave little to mend.
constexpr size_t kReinsertions = 1000;

class Optimizer {
 public:
  explicit Optimizer(BinaryTree& tree) : nodes_(tree.nodes.get()), parents_(tree.size) {
    largest_.reserve(tree.size);
    visit(0, 0);
  }

  void run() {
    const size_t n = std::min(kReinsertions, largest_.size());
    // Areas that overflow may be no number, which would not compare.
    const auto key = [&](uint32_t node) {
      const float area = nodes_[node].area();
      return area >= 0 ? -area : -kInf;
    };
    const auto larger = [&](uint32_t a, uint32_t b) {
      return std::tuple(key(a), nodes_[a].first, nodes_[a].count) <
             std::tuple(key(b), nodes_[b].first, nodes_[b].count);
    };
    std::partial_sort(largest_.begin(), largest_.begin() + static_cast<std::ptrdiff_t>(n), largest_.end(), larger);
    for (size_t i = 0; i < n; ++i) reinsert(largest_[i]);
  }

 private:
  void visit(uint32_t index, uint32_t parent) {
    parents_[index] = parent;
    if (index != 0) largest_.push_back(index);
    if (nodes_[index].left == 0) return;
    visit(nodes_[index].left, index);
    visit(nodes_[index].right, index);
  }

  static float joined_area(const BinaryNode& a, const BinaryNode& b) {
    float size[3];
    for (int k = 0; k < 3; ++k) size[k] = std::max(a.hi[k], b.hi[k]) - std::min(a.lo[k], b.lo[k]);
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
  }

  // Recomputes boxes and counts from here up.
  void refit(uint32_t index) {
    for (;; index = parents_[index]) {
      BinaryNode& node = nodes_[index];
      const BinaryNode &l = nodes_[node.left], &r = nodes_[node.right];
      for (int k = 0; k < 3; ++k) {
        node.lo[k] = std::min(l.lo[k], r.lo[k]);
        node.hi[k] = std::max(l.hi[k], r.hi[k]);
      }
      node.count = l.count + r.count;
      if (index == 0) break;
    }
  }

  void replace_child(uint32_t parent, uint32_t from, uint32_t to) {
    BinaryNode& node = nodes_[parent];
    (node.left == from ? node.left : node.right) = to;
    parents_[to] = parent;
  }

  void reinsert(uint32_t index) {
    const uint32_t parent = parents_[index];
    if (parent == 0) return;  // the root stays
    const uint32_t sibling = nodes_[parent].left == index ? nodes_[parent].right : nodes_[parent].left;
    const uint32_t grand = parents_[parent];
    replace_child(grand, parent, sibling);
    refit(grand);
    const uint32_t place = best_place(nodes_[index], sibling);
    const uint32_t above = parents_[place];
    replace_child(above, place, parent);
    nodes_[parent].left = place;
    nodes_[parent].right = index;
    parents_[place] = parents_[index] = parent;
    refit(parent);
  }

  // The node whose sibling `moved` had best become, by branch and bound; if nothing is better, the one that it had.
  uint32_t best_place(const BinaryNode& moved, uint32_t sibling) {
    const float own = moved.area();
    float cost = joined_area(nodes_[sibling], moved);
    for (uint32_t up = sibling; up != 0;) {
      up = parents_[up];
      cost += joined_area(nodes_[up], moved) - nodes_[up].area();
    }
    uint32_t best = sibling;
    heap_.clear();
    const auto nearer = [](const Entry& a, const Entry& b) { return a.growth > b.growth; };
    heap_.push_back({joined_area(nodes_[0], moved) - nodes_[0].area(), 0});
    while (!heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end(), nearer);
      const Entry e = heap_.back();
      heap_.pop_back();
      if (e.growth + own >= cost) break;
      const BinaryNode& node = nodes_[e.node];
      if (node.left == 0) continue;
      for (const uint32_t child : {node.left, node.right}) {
        const float joined = joined_area(nodes_[child], moved);
        if (e.growth + joined < cost) {
          cost = e.growth + joined;
          best = child;
        }
        const float growth = e.growth + joined - nodes_[child].area();
        if (growth + own < cost) {
          heap_.push_back({growth, child});
          std::push_heap(heap_.begin(), heap_.end(), nearer);
        }
      }
    }
    return best;
  }

  struct Entry {
    float growth;  // of the boxes above the node's children
    uint32_t node;
  };
  BinaryNode* nodes_;
  std::vector<uint32_t> parents_, largest_;
  std::vector<Entry> heap_;
};

}  // namespace

void optimize(BinaryTree& tree) { Optimizer(tree).run(); }

}  // namespace lanewise::bvh
