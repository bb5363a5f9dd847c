#include "framework/render/audit.h"

#include <cmath>

namespace aftershade {

void audit_values(const AuditedImage& image, std::vector<AuditFinding>& findings) {
    AuditFinding finding{image.pass, image.texture};
    for (std::size_t i = 0; i < image.values.size(); ++i) {
        const bool is_nan = std::isnan(image.values[i]);
        const bool is_inf = !image.infinity_allowed && std::isinf(image.values[i]);
        if (!is_nan && !is_inf) continue;
        if (finding.nan_count + finding.inf_count == 0) {
            const std::size_t pixel = i / std::size_t(image.channels);
            finding.x = int(pixel % std::size_t(image.width));
            finding.y = int(pixel / std::size_t(image.width));
        }
        finding.nan_count += is_nan;
        finding.inf_count += is_inf;
    }
    if (finding.nan_count + finding.inf_count > 0) findings.push_back(finding);
}

std::string describe_finding(const AuditFinding& finding) {
    std::string counts;
    if (finding.nan_count > 0) counts = std::to_string(finding.nan_count) + " NaN";
    if (finding.inf_count > 0)
        counts += (counts.empty() ? "" : " and ") + std::to_string(finding.inf_count) + " infinite";
    return finding.pass + ": " + finding.texture + " has " + counts + " values, the first at (" +
           std::to_string(finding.x) + ", " + std::to_string(finding.y) + ")";
}

}  // namespace aftershade
