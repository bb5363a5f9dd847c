// The passes of a manifest.
#include <algorithm>
#include <regex>
#include <utility>

#include "framework/effect/manifest/manifest_parser.h"

namespace aftershade {

using Presence = ObjectReader::Presence;

namespace {

constexpr int kMaxGroups = 65535;       // GL_MAX_COMPUTE_WORK_GROUP_COUNT is at least this
constexpr int kMaxInstances = 1 << 24;  // one a pixel of a 4096 x 4096 image
constexpr int kMaxGroupTile = 4096;

const std::vector<std::string> kKinds{"draw", "compute", "clear"};
const std::vector<std::string> kBlends{"add", "min", "max"};
const std::vector<std::string> kPrimitives{"quads", "points"};

}  // namespace

void ManifestParser::passes(const Node& section) {
    for (const Node& node : section.items) pass_or_group(node, {});
}

/// A group is {"when": {...}, "passes": [...]}: its conditions come before those of each pass in it.
void ManifestParser::pass_or_group(const Node& node, const std::vector<WhenSpec>& shared) {
    if (!node.is_object() || !node.find("passes")) return pass(node, shared);
    ObjectReader reader(node, "the group of passes", diagnostics_);
    std::vector<WhenSpec> all = shared;
    if (const Node* section = reader.object("when", Presence::required)) add_conditions(*section, all);
    if (const Node* passes = reader.array("passes", Presence::required)) {
        if (passes->items.empty()) fault(passes->place, "the group has no passes");
        for (const Node& item : passes->items) pass_or_group(item, all);
    }
    reader.finish();
}

void ManifestParser::pass(const Node& node, const std::vector<WhenSpec>& shared) {
    // What the pass is belongs into what is said of a key that only another kind has.
    const Node* kind = node.find("kind");
    const bool special = kind && (kind->string == "compute" || kind->string == "clear");
    ObjectReader reader(node, special ? "the " + kind->string + " pass" : "the pass", diagnostics_);
    if (!reader.is_object()) return;
    PassSpec pass;
    pass.place = node.place;
    pass.folder = reading_ ? reading_->spec.folder : manifest_.folder;
    pass.module = reading_ ? reading_->spec.name : "";
    pass.name = reader.text("name", Presence::required).value_or("");
    if (node.find("name")) identifier(pass.name, node.find("name")->place, "pass");
    pass.kind = choice_of(reader.choice("kind", kKinds), kKinds, PassKind::draw);
    pass.when = shared;
    if (const Node* section = reader.object("when")) add_conditions(*section, pass.when);
    if (pass.kind != PassKind::compute)
        pass.infers_writes = writes(node, reader, pass.writes) && pass.kind == PassKind::draw;
    if (pass.kind != PassKind::clear) {
        shaders(reader, node, pass);
    } else if (const Node* value = reader.any("value", Presence::required)) {
        pass.clear_value = texel(*value, "value");
    }
    reader.finish();
    manifest_.passes.push_back(std::move(pass));
}

/// What a pass that runs a shader has. A key that the pass's kind does not take is an unknown key.
void ManifestParser::shaders(ObjectReader& reader, const Node& node, PassSpec& pass) {
    pass.shader = reader.text("shader", Presence::required).value_or("");
    pass.infers_reads = reads(node, reader, pass.reads);
    if (const Node* images = reader.object("images")) pass.images = accesses(*images, "image");
    if (const Node* buffers = reader.object("buffers")) pass.buffers = accesses(*buffers, "buffer");
    if (const Node* defines = reader.object("defines"))
        for (const Member& member : defines->members) define(pass, member);
    if (const Node* repeat = reader.any("repeat")) pass.repeat = count(*repeat, "repeat", {1, kMaxRepeat, 0});
    if (const Node* bound = reader.any("max_iterations")) {
        if (bound->kind == Node::Kind::integer && bound->integer > kMaxIterations)
            fault(bound->place, "'max_iterations' is " + std::to_string(bound->integer) + " but may be " +
                                    std::to_string(kMaxIterations) +
                                    " at most: llvmpipe silently ends the loops of one invocation after "
                                    "65535; split the work over a repeated pass");
        else pass.max_iterations = int(integer_in(*bound, "max_iterations", 1, kMaxIterations));
    }
    if (pass.kind == PassKind::compute) {
        if (const Node* groups = reader.object("dispatch", Presence::required))
            pass.dispatch = dispatch(*groups);
        return;
    }
    if (const auto vertex = reader.text("vertex")) {
        pass.vertex = *vertex;
        if (vertex->empty()) fault(node.find("vertex")->place, "'vertex' is empty: it names a shader's file");
    }
    const auto over = reader.text("over");
    pass.over = over.value_or("");
    if (over && over->empty()) fault(node.find("over")->place, "'over' names no tile list");
    if (const Node* drawn = reader.object("instances")) pass.instances = instances(*drawn);
    if (pass.instances && !pass.over.empty())
        fault(node.find("over")->place, "a draw has 'instances' or is 'over' a list of tiles, not both");
    else if (pass.instances && pass.vertex.empty())
        fault(node.find("instances")->place, "'instances' need a 'vertex' shader, which places them");
    if (!pass.instances && !pass.vertex.empty() && pass.over.empty())
        fault(node.find("vertex")->place, "a 'vertex' shader needs 'instances' to place");
    if (const auto blend = reader.choice("blend", kBlends))
        pass.blend = *blend == "add" ? gpu::Blend::add : *blend == "min" ? gpu::Blend::min : gpu::Blend::max;
}

void ManifestParser::define(PassSpec& pass, const Member& member) {
    static const std::regex rule("[A-Za-z_][A-Za-z0-9_]*");
    if (!std::regex_match(member.key, rule))
        fault(member.key_place, "'" + member.key + "' cannot name a define: letters, 0-9 and _ only");
    else if (member.key.starts_with("GL_") || member.key.find("__") != std::string::npos)
        fault(member.key_place,
              "'" + member.key + "' cannot name a define: GLSL keeps GL_... and __ for itself");
    if (member.value.is_string()) pass.defines[member.key] = member.value.string;
    else if (member.value.kind == Node::Kind::integer)
        pass.defines[member.key] = std::to_string(member.value.integer);
    else fault(member.value.place, "a define is a string or an integer");
}

InstanceSpec ManifestParser::instances(const Node& node) {
    InstanceSpec instances;
    ObjectReader reader(node, "'instances'", diagnostics_);
    instances.primitive = choice_of(reader.choice("of", kPrimitives, Presence::required), kPrimitives,
                                    InstanceSpec::Primitive::quads);
    instances.grid = per(reader);
    const Node* number = reader.any("count");
    if (number) instances.count = count(*number, "count", {1, kMaxInstances, 0});
    instances.indirect = reader.text("indirect").value_or("");
    reader.finish();
    if (instances.indirect.empty() && !number && !instances.grid)
        fault(node.place, "'instances' have no 'count', 'per' or 'indirect' buffer");
    if (!instances.indirect.empty() && (number || instances.grid))
        fault(node.place,
              "'instances' are counted by their 'indirect' buffer or by 'count' and 'per', not both");
    return instances;
}

DispatchSpec ManifestParser::dispatch(const Node& node) {
    DispatchSpec dispatch;
    ObjectReader reader(node, "'dispatch'", diagnostics_);
    const Node* tile = reader.any("tile");
    const Node* groups = reader.any("groups");
    const auto indirect = reader.text("indirect");
    if (int(tile != nullptr) + int(groups != nullptr) + int(indirect.has_value()) != 1)
        fault(node.place, "'dispatch' has one of 'tile', 'groups' and 'indirect'");
    if (tile) dispatch.tile = count(*tile, "tile", {1, kMaxGroupTile, 1});
    if (const auto over = tile ? reader.text("over") : std::nullopt) dispatch.over = *over;
    if (groups) {
        dispatch.kind = DispatchSpec::Kind::groups;
        const std::vector<int> counts = integers_in(*groups, "groups", 3, 1, kMaxGroups);
        std::copy(counts.begin(), counts.end(), dispatch.groups);
    }
    if (indirect) {
        dispatch.kind = DispatchSpec::Kind::indirect;
        dispatch.indirect = *indirect;
    }
    reader.finish();
    return dispatch;
}

}  // namespace aftershade
