// Where values that are not numbers come from.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

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

/// An audited image, and its name in a finding. [refers to the values]
struct AuditedImage {
    std::span<const float> values;
    int width = 0;
    int channels = 0;
    bool infinity_allowed = false;  ///< depth, where +inf is nothing hit
    std::string pass{};
    std::string texture{};
};

/// Looks at every value; adds a finding if there is one to report.
void audit_values(const AuditedImage& image, std::vector<AuditFinding>& findings);

/// "bokeh.second: bokeh.color has 12 NaN and 3 infinite values, the first at (10, 4)".
std::string describe_finding(const AuditFinding& finding);

}  // namespace aftershade
