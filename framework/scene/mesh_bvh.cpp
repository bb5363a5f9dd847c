#include "framework/scene/mesh.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>

namespace aftershade::scene {

namespace {

class BvhBuilder {
public:
    BvhBuilder(std::span<const Bounds> boxes, int leaf_size) : boxes_(boxes), leaf_size_(leaf_size) {}

    Bvh build() {
        bvh_.items.resize(boxes_.size());
        std::iota(bvh_.items.begin(), bvh_.items.end(), 0u);
        if (!boxes_.empty()) add_node(0, bvh_.items.size());
        return std::move(bvh_);
    }

private:
    // Halves before it adds, so that the ends of a far box do not overflow.
    glm::dvec3 centre(std::uint32_t item) const { return 0.5 * boxes_[item].low + 0.5 * boxes_[item].high; }

    void add_node(std::size_t begin, std::size_t end) {
        const std::size_t node = bvh_.nodes.size();
        bvh_.nodes.emplace_back();
        for (std::size_t i = begin; i < end; ++i) bvh_.nodes[node].bounds.add(boxes_[bvh_.items[i]]);
        if (end - begin <= std::size_t(leaf_size_)) make_leaf(bvh_.nodes[node], begin, end);
        else split(begin, end);
        bvh_.nodes[node].skip = std::uint32_t(bvh_.nodes.size());
    }

    void make_leaf(BvhNode& node, std::size_t begin, std::size_t end) {
        // nth_element leaves the order inside a half to the library.
        std::sort(bvh_.items.begin() + std::ptrdiff_t(begin), bvh_.items.begin() + std::ptrdiff_t(end));
        node.first = std::uint32_t(begin);
        node.count = std::uint32_t(end - begin);
    }

    void split(std::size_t begin, std::size_t end) {
        Bounds centres;
        for (std::size_t i = begin; i < end; ++i) centres.add(centre(bvh_.items[i]));
        const glm::dvec3 size = centres.high - centres.low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::size_t middle = begin + (end - begin) / 2;
        const auto at = [&](std::size_t i) { return bvh_.items.begin() + std::ptrdiff_t(i); };
        // The index decides between equal centres: a total order, hence the same halves everywhere.
        std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
            const double x = centre(a)[axis];
            const double y = centre(b)[axis];
            return x < y || (x == y && a < b);
        });
        add_node(begin, middle);
        add_node(middle, end);
    }

    std::span<const Bounds> boxes_;
    int leaf_size_;
    Bvh bvh_;
};

}  // namespace

Bvh build_bvh(std::span<const Bounds> items, int leaf_size) {
    assert(leaf_size >= 1 && items.size() < std::numeric_limits<std::uint32_t>::max() / 2);
    return BvhBuilder(items, leaf_size).build();
}

}  // namespace aftershade::scene
