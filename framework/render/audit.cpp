#include "framework/render/audit.h"

#include <cmath>
#include <map>
#include <span>

#include "framework/render/graph_builder.h"

namespace aftershade {

namespace {

/// An audited image, and its name in a finding.
struct AuditedImage {
    std::span<const float> values;
    int width = 0;
    int channels = 0;
    bool infinity_allowed = false;
    std::string pass{};
    std::string texture{};
};

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

bool infinity_allowed(const RoleId& role) {
    return std::isinf(find_role(role)->outside);
}

}  // namespace

void audit_image(const RoleId& role, const Image& image, const std::string& pass, const std::string& texture,
                 std::vector<AuditFinding>& findings) {
    if (image.type() != ComponentType::float32) return;
    audit_values({image.floats(), image.width(), image.channels(), infinity_allowed(role), pass, texture},
                 findings);
}

graph::Executor::PassObserver auditor(const Pipeline& pipeline, std::vector<AuditFinding>& findings) {
    std::map<std::string, std::string> role_of_output;
    for (const PipelineStep& step : pipeline.steps)
        for (const OutputSpec& output : step.manifest->outputs)
            role_of_output[step.name + "." + output.name] = output.role;
    return [role_of_output, &findings](const std::string& pass, const std::string& texture,
                                       const gpu::Texture& target) {
        const gpu::TextureDesc& desc = target.desc();
        if (gpu::is_integer(desc.format)) return;
        // What these write has been looked at.
        for (const char* grid : {kToSquarePixels, kToStoredPixels, kToDisplayWindow, kToDataWindow})
            if (texture.ends_with(grid)) return;
        const auto role = role_of_output.find(texture);
        const bool infinity = role != role_of_output.end() && infinity_allowed(role->second);
        const std::vector<float> values = target.read_floats();
        audit_values({values, desc.width, gpu::channel_count(desc.format), infinity, pass, texture},
                     findings);
    };
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
