// Whether draws run as fragment or as compute shaders.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "framework/effect/program_store.h"
#include "framework/render/renderer_options.h"

namespace aftershade {

/// "auto", "fragment", "compute".
std::optional<DrawWith> parse_draw_with(std::string_view name);
std::string_view draw_with_name(DrawWith way);

/// `wanted`, or where that is automatic, what $AFTERSHADE_DRAW_WITH names, or else what is faster with this
/// context: `fragment` on software GL, and elsewhere what a measurement of some milliseconds finds, which
/// `store` keeps for the next process. Throws Error(ErrorKind::usage) for an unknown name in the variable.
DrawWith chosen_draw_with(gpu::Context& context, DrawWith wanted, const ProgramStore& store);

}  // namespace aftershade
