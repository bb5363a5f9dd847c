// The passes of a manifest.
#include <algorithm>
#include <regex>
#include <utility>

#include "framework/effect/manifest_parser.h"

namespace aftershade {

using Presence = ObjectReader::Presence;

namespace {

constexpr int kMaxGroups = 65535;       // GL_MAX_COMPUTE_WORK_GROUP_COUNT is at least this
constexpr int kMaxInstances = 1 << 24;  // one a pixel of a 4096 x 4096 image
constexpr int kMaxGroupTile = 4096;
constexpr int kMaxLevel = 14;  // of 16384 texels a side

const std::vector<std::string> kKinds{"draw", "compute", "clear"};
const std::vector<std::string> kFilters{"nearest", "linear"};
const std::vector<std::string> kOutside{"clamp", "weight_zero"};
const std::vector<std::string> kAccess{"read", "write", "atomic"};
const std::vector<std::string> kBlends{"add", "min", "max"};
const std::vector<std::string> kPrimitives{"quads", "points"};

/// "name.prev" is the last frame's: takes the end off and says whether it was there.
bool take_prev(std::string& name) {
    constexpr std::string_view kPrev = ".prev";
    if (!name.ends_with(kPrev)) return false;
    name.resize(name.size() - kPrev.size());
    return true;
}

template <typename T>
T choice_of(const std::optional<std::string>& text, const std::vector<std::string>& names, T otherwise) {
    if (!text) return otherwise;
    return T(std::find(names.begin(), names.end(), *text) - names.begin());
}

}  // namespace

void ManifestParser::passes(const Node& section) {
    for (const Node& node : section.items) pass(node);
}

void ManifestParser::pass(const Node& node) {
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
    if (const Node* conditions = reader.object("when"))
        for (const Member& member : conditions->members) pass.when.push_back(when(member));
    if (const Node* writes = pass.kind == PassKind::compute ? nullptr : reader.array("writes"))
        for (const Node& item : writes->items) pass.writes.push_back(write(item));
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
    if (const Node* reads = reader.array("reads"))
        for (const Node& item : reads->items) pass.reads.push_back(read(item));
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
    pass.vertex = reader.text("vertex").value_or("");
    if (const Node* drawn = reader.object("instances")) pass.instances = instances(*drawn);
    if (pass.instances && pass.vertex.empty())
        fault(node.find("instances")->place, "'instances' need a 'vertex' shader, which places them");
    if (!pass.instances && !pass.vertex.empty())
        fault(node.find("vertex")->place, "a 'vertex' shader needs 'instances' to place");
    if (const auto blend = reader.choice("blend", kBlends))
        pass.blend = *blend == "add" ? gpu::Blend::add : *blend == "min" ? gpu::Blend::min : gpu::Blend::max;
}

ReadSpec ManifestParser::read(const Node& node) {
    ReadSpec read;
    read.place = node.place;
    if (node.is_string()) {
        read.name = node.string;
    } else if (!node.is_object() || node.members.size() != 1) {
        fault(node.place,
              "a read is a name, or an object of one name with its filter: {\"color\": \"linear\"}");
    } else {
        read.name = node.members[0].key;
        read_options(node.members[0], read);
    }
    read.previous = take_prev(read.name);
    return read;
}

void ManifestParser::read_options(const Member& member, ReadSpec& read) {
    if (member.value.is_object()) {
        ObjectReader reader(member.value, "the read of '" + member.key + "'", diagnostics_);
        read.filter = choice_of(reader.choice("filter", kFilters), kFilters, gpu::Filter::nearest);
        read.wrap = choice_of(reader.choice("outside", kOutside), kOutside, gpu::Wrap::clamp);
        if (const Node* one = reader.any("level")) read.level = level(*one, "level", kMaxLevel);
        reader.finish();
    } else if (member.value.is_string() &&
               (member.value.string == "linear" || member.value.string == "nearest")) {
        if (member.value.string == "linear") read.filter = gpu::Filter::linear;
    } else {
        fault(member.value.place, "the filter of a read is 'nearest' or 'linear'");
    }
}

WriteSpec ManifestParser::write(const Node& node) {
    WriteSpec write;
    write.place = node.place;
    if (node.is_string()) {
        write.name = node.string;
    } else if (!node.is_object() || node.members.size() != 1) {
        fault(node.place,
              "a write is a name, or an object of one name with its place: {\"pyramid\": {\"level\": 1}}");
    } else {
        write.name = node.members[0].key;
        ObjectReader reader(node.members[0].value, "the write of '" + write.name + "'", diagnostics_);
        if (const Node* one = reader.any("level")) write.level = level(*one, "level", kMaxLevel);
        if (const Node* one = reader.any("layer")) write.layer = level(*one, "layer", kMaxLayers - 1);
        reader.finish();
    }
    return write;
}

int ManifestParser::level(const Node& node, const std::string& key, int most) {
    static const std::regex rule(R"(pass\.index(?: *([+-]) *(\d{1,2}))?)");
    std::smatch match;
    if (node.kind == Node::Kind::integer) return int(integer_in(node, key, 0, most));
    if (!node.is_string() || !std::regex_match(node.string, match, rule)) {
        fault(node.place,
              "'" + key + "' is an integer, \"pass.index\", \"pass.index + 1\" or \"pass.index - 1\"");
        return 0;
    }
    const int offset = match[2].matched ? std::stoi(match[2]) : 0;
    return kPassIndex + (match[1] == "-" ? -offset : offset);
}

std::vector<AccessSpec> ManifestParser::accesses(const Node& section, const std::string& thing) {
    std::vector<AccessSpec> accesses;
    for (const Member& member : section.members) {
        AccessSpec access;
        access.name = member.key;
        access.place = member.key_place;
        access.previous = take_prev(access.name);
        const auto found = std::find(kAccess.begin(), kAccess.end(), member.value.string);
        if (!member.value.is_string() || found == kAccess.end())
            fault(member.value.place,
                  "the access to the " + thing + " '" + member.key + "' is " + list_of_names(kAccess));
        else access.kind = AccessSpec::Kind(found - kAccess.begin());
        accesses.push_back(std::move(access));
    }
    return accesses;
}

WhenSpec ManifestParser::when(const Member& member) {
    WhenSpec condition;
    condition.subject = member.key;
    condition.place = member.key_place;
    const auto add = [&](const Node& value) {
        if (value.kind == Node::Kind::boolean) condition.values.emplace_back(value.boolean);
        else if (value.kind == Node::Kind::integer) condition.values.emplace_back(value.integer);
        else if (value.is_string()) condition.values.emplace_back(value.string);
        else fault(value.place, "a condition compares with true, false, an integer or a name");
    };
    if (member.value.is_array())
        for (const Node& item : member.value.items) add(item);
    else add(member.value);
    if (member.value.is_array() && member.value.items.empty())
        fault(member.value.place, "the condition '" + member.key + "' has no value, so it never holds");
    return condition;
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
