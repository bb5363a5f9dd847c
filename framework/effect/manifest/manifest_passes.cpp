// The passes of a manifest.
#include <algorithm>
#include <utility>

#include "framework/effect/manifest/manifest_parser.h"

namespace aftershade {

void ManifestParser::passes(const Reader& document) {
    for (const Reader& reader : document.objects("passes")) manifest_.passes.push_back(pass(reader));
}

PassSpec ManifestParser::pass(const Reader& reader) {
    PassSpec pass;
    pass.place = reader.node().place;
    pass.folder = reading_ ? reading_->spec.folder : manifest_.folder;
    pass.module = reading_ ? reading_->spec.name : "";
    // One that is not snake_case names the pass in messages nevertheless.
    if (const Node* name = reader.node().find("name")) pass.name = name->string;
    add_conditions(reader, pass.when);
    if (reader.kind() == "copy") {
        copied(reader, pass);
    } else if (reader.kind() == "clear") {
        read_writes(reader, pass.writes);
        pass.work = ClearSpec{reader.has("value") ? reader.numbers("value") : std::vector<double>{}};
    } else if (reader.kind() == "compute") {
        shaders(reader, pass, ".comp");
        const auto groups = reader.object("dispatch");
        pass.work = ComputeSpec{groups ? dispatch(*groups) : DispatchSpec{}, std::nullopt};
    } else {
        pass.infers_writes = read_writes(reader, pass.writes);
        shaders(reader, pass, ".frag");
        pass.work = drawn(reader);
    }
    return pass;
}

void ManifestParser::copied(const Reader& reader, PassSpec& pass) {
    pass.work = CopySpec{};
    ReadSpec from;
    from.name = reader.text("from");
    from.place = reader.place("from");
    from.previous = take_prev(from.name);
    pass.reads = {from};
    WriteSpec to;
    to.name = reader.text("to");
    to.place = reader.place("to");
    pass.writes = {to};
}

/// What a pass that runs a shader has.
void ManifestParser::shaders(const Reader& reader, PassSpec& pass, const std::string& ending) {
    pass.shader = reader.has("shader") ? reader.text("shader") : pass.name + ending;
    pass.infers_reads = read_reads(reader, pass.reads);
    pass.images = read_accesses(reader, "images");
    pass.buffers = read_accesses(reader, "buffers");
    if (const Node* defines = reader.find("defines"))
        for (const auto& [name, place, value] : defines->members)
            pass.defines[name] = value.is_string() ? value.string : std::to_string(value.integer);
    if (reader.has("repeat")) pass.repeat = count(reader, "repeat", kRepeatCount);
    pass.max_iterations = int(reader.integer("max_iterations"));
}

DrawSpec ManifestParser::drawn(const Reader& reader) {
    DrawSpec draw;
    if (reader.has("vertex")) draw.vertex = reader.text("vertex");
    if (reader.has("over")) draw.over = reader.text("over");
    if (const auto instance = reader.object("instances")) draw.instances = instances(*instance);
    const std::string blend = reader.text("blend");
    if (blend == "add") draw.blend = gpu::Blend::add;
    if (blend == "min") draw.blend = gpu::Blend::min;
    if (blend == "max") draw.blend = gpu::Blend::max;
    return draw;
}

InstanceSpec ManifestParser::instances(const Reader& reader) {
    InstanceSpec instances;
    instances.primitive = reader.choice<InstanceSpec::Primitive>("of");
    instances.grid = per(reader);
    instances.count = count(reader, "count", kInstanceCount);
    instances.indirect = reader.text("indirect");
    instances.covers = reader.boolean("covers");
    return instances;
}

DispatchSpec ManifestParser::dispatch(const Reader& reader) {
    DispatchSpec dispatch;
    if (reader.has("tile")) dispatch.tile = count(reader, "tile", kGroupTileCount);
    dispatch.over = reader.text("over");
    if (reader.has("groups")) {
        dispatch.kind = DispatchSpec::Kind::groups;
        const std::vector<int> counts = integers_of(reader, "groups", 3);
        std::copy(counts.begin(), counts.end(), dispatch.groups);
    }
    if (reader.has("indirect")) {
        dispatch.kind = DispatchSpec::Kind::indirect;
        dispatch.indirect = reader.text("indirect");
    }
    return dispatch;
}

}  // namespace aftershade
