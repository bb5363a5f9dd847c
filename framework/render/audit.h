// Where values that are not numbers come from.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "framework/graph/executor.h"
#include "framework/image/role.h"
#include "framework/look/pipeline.h"

namespace aftershade {

/// Non-finite values of one image: an input of the pipeline, or a texture that a pass has written.
struct AuditFinding {
    std::string pass;     ///< "bokeh.second"; "capture" for an input
    std::string texture;  ///< "bokeh.color", "capture.color"
    std::size_t nan_count = 0;
    std::size_t inf_count = 0;
    int x = 0;  ///< the first such pixel, rows from the top
    int y = 0;
};

/// Adds a finding if a role's image of floats has NaN, or has infinity although the role's value outside an
/// image is finite. Depth may be +inf, where nothing is hit.
void audit_image(const RoleId& role, const Image& image, const std::string& pass, const std::string& texture,
                 std::vector<AuditFinding>& findings);

/// Looks at every texture of floats that passes write; integer textures hold ids and packed bits, of which no
/// value is wrong. `findings` must outlive it.
graph::Executor::PassObserver auditor(const Pipeline& pipeline, std::vector<AuditFinding>& findings);

/// "bokeh.second: bokeh.color has 12 NaN and 3 infinite values, the first at (10, 4)".
std::string describe_finding(const AuditFinding& finding);

}  // namespace aftershade
