// Whether draws run as fragment or as compute shaders.
#pragma once

#include <optional>
#include <string_view>

#include "framework/effect/pass_program.h"
#include "framework/render/renderer_options.h"

namespace aftershade {

/// "auto", "fragment", "compute".
std::optional<DrawWith> parse_draw_with(std::string_view name);
std::string_view draw_with_name(DrawWith way);

/// What is faster on this renderer: `fragment` on software GL, whose compute shaders gain nothing
/// (docs/gpu.md), and elsewhere what some milliseconds of measuring find, which the store of `programs` keeps
/// for the next process.
DrawWith faster_draw_with(gpu::Context& context, ProgramCache& programs);

/// `wanted`, or where that is automatic what $AFTERSHADE_DRAW_WITH names, or else the faster way. Throws
/// Error(ErrorKind::usage) for an unknown name in the variable.
DrawWith chosen_draw_with(gpu::Context& context, DrawWith wanted, ProgramCache& programs);

}  // namespace aftershade
