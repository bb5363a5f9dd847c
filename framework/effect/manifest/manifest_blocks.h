// The parts of the grammar of manifests, for the parser that reads what they have checked. Internal to
// framework/effect.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/document/grammar.h"
#include "framework/effect/manifest/manifest.h"

namespace aftershade {

/// Limits of a count: of a number, and of a parameter that is named in its place.
struct CountLimits {
    std::int64_t least = 1;
    std::int64_t most = 1;
    int least_of_param = 1;  ///< least `min` of the parameter
};

inline constexpr CountLimits kTileCount{2, 4096};
inline constexpr CountLimits kGroupTileCount{1, 4096};
inline constexpr CountLimits kRepeatCount{1, kMaxRepeat, 0};
inline constexpr CountLimits kInstanceCount{1, 1 << 24, 0};  ///< one a pixel of a 4096 x 4096 image
inline constexpr CountLimits kPerTexelCount{1, 256};
/// Limits of a buffer without a grid, by its elements' type.
CountLimits element_count(const std::string& element);
/// Number of components of a vector's type: 4 for "uvec4".
int components_of(const std::string& element);

inline constexpr int kMaxBins = 1024;

/// "pass.index + 1" as 1; nullopt for any other text.
std::optional<int> pass_offset(std::string_view text);

// ---- forms ----

/// The rule for a thing's name: "the id '{}' must be snake_case ...".
grammar::Form identifier_form(const std::string& thing);
/// Text that names what stands elsewhere. The schema checks only how it is written; the parser, which has the
/// declarations, reports every other.
grammar::Form reference_form(const std::string& pattern, const std::string& type);
/// A number, or the name of an int parameter.
grammar::Form count_form(const CountLimits& limits);
/// A number for every channel, or four of them.
grammar::Form texel_form();
/// "history.a"
grammar::Form channel_form();
grammar::Form grid_scale_form();
/// "pixel", {"tile": n} or {"scale": x}
grammar::Form per_form();
grammar::Form reads_form();

// ---- blocks ----

/// Conditions of a pass, a read, a write, a texture or a tile list.
grammar::Key when_key(std::string doc, bool is_required = false);
/// Those of an input, which name parameters alone.
grammar::Key input_when_key(std::string doc);

const grammar::Block& manifest_param_block();
const grammar::Block& input_block();
const grammar::Block& texture_block();
const grammar::Block& buffer_block();
const grammar::Block& tile_list_block();
const grammar::Block& pass_block();
const grammar::Block& read_block();   ///< of one read, by its name
const grammar::Block& write_block();  ///< of one write, by its name

}  // namespace aftershade
