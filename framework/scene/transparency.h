// Surfaces that let light through, under many visibility samples: a sample stops at them by chance (Enderton,
// Sintorn, Shirley and Luebke 2010, Stochastic Transparency), or what it crosses is kept in lists (Yang,
// Hensley, Grun and Thibieroz 2010, Real-Time Concurrent Linked List Construction on the GPU).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "framework/scene/world.h"

namespace aftershade::scene {

enum class Transparency {
    stochastic,  ///< a sample shows one surface: each that it crosses with the probability of its opacity
    lists,       ///< a sample blends all that it crosses, out of a list for each pixel
    sorted       ///< a sample blends all that it crosses as it goes, and keeps none of it
};

/// "stochastic", "lists", "sorted"; nullopt for anything else.
std::optional<Transparency> parse_transparency(std::string_view name);

inline constexpr int kMaxListNodes = 4096;

struct TransparencySettings {
    Transparency transparency = Transparency::stochastic;
    int list_nodes = 256;  ///< lists: nodes for each pixel, shared by the pixels of a row; 0 to kMaxListNodes
};

/// Where a sample of a pixel stops. Over the samples of the pixel the numbers for the first two surfaces fill
/// the unit square evenly, those for the next two another square, and later ones are independent.
class StopNumbers {
public:
    /// Sample `sample` of `samples` of a pixel whose own seed is `pixel_seed`.
    StopNumbers(std::uint32_t pixel_seed, int sample, int samples);
    static std::uint32_t pixel_seed(std::uint32_t seed, int frame, int x, int y);

    /// In [0, 1): the sample stops at the surface that it crosses as its `crossing`-th, from 0, if this is
    /// less than the surface's opacity.
    double at(int crossing) const;
    const std::array<double, 4>& first() const { return first_; }

private:
    std::uint32_t pixel_seed_;
    std::uint32_t sample_;
    std::array<double, 4> first_{};
};

/// The surface at which the sample stops; opaque ones stop all.
std::optional<Surface> trace_stochastic(const World& world, const Ray& ray, const StopNumbers& stops);

/// A surface that a sample has crossed.
struct ListNode {
    std::uint32_t id = 0;  ///< of its shading sample
    float t = 0;           ///< along the ray
    float opacity = 0;
    std::uint32_t sample = 0;
    std::uint32_t next = 0xffffffff;  ///< index of the pixel's next node in its row
};

/// A linked list of each pixel. Pixels of one row share nodes; different rows may be filled on different
/// threads, and what fits does not depend on their number.
class TransparentLists {
public:
    TransparentLists(int width_px, int height_px, int nodes_of_pixel);

    /// False and counted where the row has no node left.
    bool add(int x, int y, ListNode node);
    /// The pixel's nodes by sample, the nearest first.
    std::vector<ListNode> sorted(int x, int y) const;

    std::uint64_t node_count() const;
    std::uint64_t overflows() const;
    /// Memory of the nodes, and of a head for each pixel.
    std::uint64_t bytes() const;

private:
    struct Row {
        std::vector<std::uint32_t> heads;
        std::vector<ListNode> nodes;
        std::uint64_t overflows = 0;
    };
    std::size_t nodes_of_row_;
    std::vector<Row> rows_;
};

}  // namespace aftershade::scene
