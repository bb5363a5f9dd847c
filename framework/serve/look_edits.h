// Changes of a look's text that leave every byte alone which they need not change: comments, the order of
// keys and the author's own line breaks.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace aftershade::serve {

/// The text after one edit of the page: {"op": "set", "step": 1, "param": "exposure", "value": 0.5}. `text`
/// is one that parse_document() takes. Throws Error(ErrorKind::usage) for an edit of another form, or that
/// names a step which is not there.
std::string edited(const std::string& text, const nlohmann::ordered_json& edit);

}  // namespace aftershade::serve
