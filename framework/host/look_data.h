// A look bound to its effects, and the values that a program set above its own.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "aftershade/host.h"
#include "aftershade/look.h"
#include "framework/base/diagnostics.h"
#include "framework/document/document.h"
#include "framework/effect/registry.h"
#include "framework/look/look.h"
#include "framework/look/pipeline.h"

namespace aftershade::host {

struct LookCore {
    explicit LookCore(EffectRegistry registry) : effects(std::move(registry)) {}

    EffectRegistry effects;
    aftershade::Look look;
    aftershade::Pipeline pipeline;  // what renderers refer to; changes in place
    std::vector<std::string> taps;
    std::map<std::string, Node> overrides;  // by "step.param"
    std::vector<Diagnostic> warnings;
    std::shared_ptr<const std::vector<std::filesystem::path>> documents;  // that were read
    int form = 1;      // another number: the graph must be built again
    int revision = 1;  // another number: some value changed

    /// Binds the look with these values above its own, and takes both over. Throws Error(kind) with every
    /// fault, and is then as it was.
    void bind(std::map<std::string, Node> values, ErrorKind kind);
};

class Rendering;

struct Look::Data {
    std::shared_ptr<Host::Data> host;
    std::shared_ptr<LookCore> core;
    std::unique_ptr<Rendering> rendering;  // of frames by themselves
};

/// Roles that some step makes, sorted.
std::vector<std::string> made_roles(const Pipeline& pipeline);

/// A value as a document has it, at `place`. nullopt after a fault.
std::optional<Node> node_of(const Value& value, const std::string& name, Diagnostics& faults);
Value value_of(const ParamSpec& spec, const ParamValue& value);
Value value_of(const ParamSpec& spec, const ValueSource& source);
ParamInfo info_of(const ParamSpec& spec);

}  // namespace aftershade::host
