#include "framework/scene/transparency.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "framework/base/names.h"
#include "framework/scene/samples.h"

namespace aftershade::scene {

namespace {

constexpr Names<Transparency, 3> kTransparencyNames = {{{Transparency::stochastic, "stochastic"},
                                                        {Transparency::lists, "lists"},
                                                        {Transparency::sorted, "sorted"}}};

constexpr std::uint32_t kNoNode = 0xffffffff;

}  // namespace

std::optional<Transparency> parse_transparency(std::string_view name) {
    return value_named(kTransparencyNames, name);
}

std::uint32_t StopNumbers::pixel_seed(std::uint32_t seed, int frame, int x, int y) {
    const std::uint32_t of_frame = pcg3d(seed, std::uint32_t(frame), 0x51ed270bu)[0];
    return pcg3d(std::uint32_t(x), std::uint32_t(y), of_frame)[0];
}

StopNumbers::StopNumbers(std::uint32_t pixel_seed, int sample, int samples)
    : pixel_seed_(pixel_seed), sample_(std::uint32_t(sample)) {
    for (std::size_t pair = 0; pair < 2; ++pair) {
        const std::uint32_t seed = pcg3d(pixel_seed, std::uint32_t(pair), 0x9e3779b9u)[0];
        const auto count = std::uint32_t(samples);
        const glm::dvec2 point = shifted_hammersley(permuted(sample_, count, seed), count, seed);
        first_[2 * pair] = point.x;
        first_[2 * pair + 1] = point.y;
    }
}

double StopNumbers::at(int crossing) const {
    if (crossing < int(first_.size())) return first_[std::size_t(crossing)];
    return pcg3d(pixel_seed_, sample_, std::uint32_t(crossing))[0] / 4294967296.0;
}

std::optional<Surface> trace_stochastic(const World& world, const Ray& ray, const StopNumbers& stops) {
    std::optional<Surface> met;
    int crossing = 0;
    world.cross(ray, [&](const Surface& surface) {
        const double opacity = world.opacity_of(surface, ray.origin);
        if (opacity < 1 && stops.at(crossing++) >= opacity) return true;
        met = surface;
        return false;
    });
    return met;
}

TransparentLists::TransparentLists(int width_px, int height_px, int nodes_of_pixel)
    : nodes_of_row_(std::size_t(width_px) * std::size_t(nodes_of_pixel)),
      rows_(std::size_t(height_px), Row{std::vector(std::size_t(width_px), kNoNode), {}, 0}) {}

bool TransparentLists::add(int x, int y, ListNode node) {
    Row& row = rows_[std::size_t(y)];
    if (row.nodes.size() == nodes_of_row_) {
        ++row.overflows;
        return false;
    }
    std::uint32_t& head = row.heads[std::size_t(x)];
    node.next = std::exchange(head, std::uint32_t(row.nodes.size()));
    row.nodes.push_back(node);
    return true;
}

std::vector<ListNode> TransparentLists::sorted(int x, int y) const {
    const Row& row = rows_[std::size_t(y)];
    std::vector<ListNode> list;
    for (std::uint32_t at = row.heads[std::size_t(x)]; at != kNoNode; at = row.nodes[at].next)
        list.push_back(row.nodes[at]);
    // The newest stands first, so that equal ones come in the order in which they were added.
    std::reverse(list.begin(), list.end());
    std::stable_sort(list.begin(), list.end(), [](const ListNode& a, const ListNode& b) {
        return std::tie(a.sample, a.t) < std::tie(b.sample, b.t);
    });
    return list;
}

std::uint64_t TransparentLists::node_count() const {
    std::uint64_t count = 0;
    for (const Row& row : rows_) count += row.nodes.size();
    return count;
}

std::uint64_t TransparentLists::overflows() const {
    std::uint64_t count = 0;
    for (const Row& row : rows_) count += row.overflows;
    return count;
}

std::uint64_t TransparentLists::bytes() const {
    const std::uint64_t heads = rows_.empty() ? 0 : rows_.size() * rows_.front().heads.size();
    return node_count() * sizeof(ListNode) + heads * sizeof(std::uint32_t);
}

}  // namespace aftershade::scene
