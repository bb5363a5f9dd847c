// Forms of values that documents about captures share.
#pragma once

#include <string>

#include "framework/document/grammar.h"

namespace aftershade {

/// "1-100x2,120": at least one frame. `fault` is the message for a text that is not a range; "{}" is the
/// text.
grammar::Form frame_range_form(const std::string& fault);

}  // namespace aftershade
