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
    if (reader.kind() == "compute") pass.kind = PassKind::compute;
    if (reader.kind() == "clear") pass.kind = PassKind::clear;
    if (reader.kind() == "copy") pass.kind = PassKind::copy;
    add_conditions(reader, pass.when);
    if (pass.kind == PassKind::copy) {
        copied(reader, pass);
        return pass;
    }
    if (pass.kind != PassKind::compute)
        pass.infers_writes = read_writes(reader, pass.writes) && pass.kind == PassKind::draw;
    if (pass.kind != PassKind::clear) shaders(reader, pass);
    else if (reader.has("value")) pass.clear_value = reader.numbers("value");
    return pass;
}

void ManifestParser::copied(const Reader& reader, PassSpec& pass) {
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
void ManifestParser::shaders(const Reader& reader, PassSpec& pass) {
    const char* const ending = pass.kind == PassKind::compute ? ".comp" : ".frag";
    pass.shader = reader.has("shader") ? reader.text("shader") : pass.name + ending;
    pass.infers_reads = read_reads(reader, pass.reads);
    pass.images = read_accesses(reader, "images");
    pass.buffers = read_accesses(reader, "buffers");
    if (const Node* defines = reader.find("defines"))
        for (const auto& [name, place, value] : defines->members)
            pass.defines[name] = value.is_string() ? value.string : std::to_string(value.integer);
    if (reader.has("repeat")) pass.repeat = count(reader, "repeat", kRepeatCount);
    pass.max_iterations = int(reader.integer("max_iterations"));
    if (pass.kind == PassKind::compute) {
        if (const auto groups = reader.object("dispatch")) pass.dispatch = dispatch(*groups);
        return;
    }
    pass.vertex = reader.text("vertex");
    pass.over = reader.text("over");
    if (const auto drawn = reader.object("instances")) pass.instances = instances(*drawn);
    const std::string blend = reader.text("blend");
    if (blend == "add") pass.blend = gpu::Blend::add;
    if (blend == "min") pass.blend = gpu::Blend::min;
    if (blend == "max") pass.blend = gpu::Blend::max;
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
