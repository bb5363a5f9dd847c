// What a pass of a manifest reads and writes.
#include "framework/effect/manifest/manifest_parser.h"

namespace aftershade {

using grammar::Reader;

bool take_prev(std::string& name) {
    constexpr std::string_view kPrev = ".prev";
    if (!name.ends_with(kPrev)) return false;
    name.resize(name.size() - kPrev.size());
    return true;
}

namespace {

std::optional<TurnIndex> turn_index(const Reader& reader, const std::string& key) {
    const Node* node = reader.find(key);
    if (!node) return std::nullopt;
    if (node->is_string()) return TurnIndex{pass_offset(node->string).value_or(0), true};
    return TurnIndex{int(node->integer)};
}

/// A name, or the one member of an object. "" after a fault.
std::string name_of_use(const Node& item) {
    if (item.is_string()) return item.string;
    return item.members.size() == 1 ? item.members[0].key : "";
}

ReadSpec read_of(const Node& item) {
    ReadSpec read;
    read.place = item.place;
    read.name = name_of_use(item);
    read.previous = take_prev(read.name);
    if (item.members.size() != 1) return read;
    const Node& options = item.members[0].value;
    const Reader reader(options, read_block());
    const std::string filter = options.is_string() ? options.string : reader.text("filter");
    if (filter == "linear") read.filter = gpu::Filter::linear;
    read.is_pixel = filter == "pixel";
    read.wrap = reader.choice<gpu::Wrap>("outside");
    read.level = turn_index(reader, "level");
    add_conditions(reader, read.when);
    return read;
}

WriteSpec write_of(const Node& item) {
    WriteSpec write;
    write.place = item.place;
    write.name = name_of_use(item);
    if (item.members.size() != 1) return write;
    const Reader reader(item.members[0].value, write_block());
    write.level = turn_index(reader, "level").value_or(TurnIndex{});
    write.layer = turn_index(reader, "layer").value_or(TurnIndex{});
    add_conditions(reader, write.when);
    return write;
}

/// Appends to `uses` what the items of a list are; true where there is no list, or an item is "*".
template <class Use>
bool read_uses(const Reader& owner, const std::string& key, Use (*use_of)(const Node& item),
               std::vector<Use>& uses) {
    const Node* list = owner.find(key);
    bool infers = !owner.node().find(key);
    if (list)
        for (const Node& item : list->items) {
            if (item.is_string() && item.string == "*") infers = true;
            else uses.push_back(use_of(item));
        }
    return infers;
}

}  // namespace

bool read_reads(const Reader& owner, std::vector<ReadSpec>& reads) {
    return read_uses(owner, "reads", read_of, reads);
}

bool read_writes(const Reader& owner, std::vector<WriteSpec>& writes) {
    return read_uses(owner, "writes", write_of, writes);
}

std::vector<AccessSpec> read_accesses(const Reader& pass, const std::string& key) {
    std::vector<AccessSpec> accesses;
    const Node* section = pass.find(key);
    if (!section) return accesses;
    for (const Member& member : section->members) {
        AccessSpec access;
        access.name = member.key;
        access.place = member.key_place;
        access.previous = take_prev(access.name);
        if (member.value.string == "write") access.kind = AccessSpec::Kind::write;
        if (member.value.string == "atomic") access.kind = AccessSpec::Kind::atomic;
        accesses.push_back(std::move(access));
    }
    return accesses;
}

std::vector<int> integers_of(const Reader& reader, const std::string& key, std::size_t size) {
    std::vector<int> values(size, 1);
    if (const Node* list = reader.find(key))
        for (std::size_t i = 0; i < std::min(size, list->items.size()); ++i)
            if (list->items[i].kind == Node::Kind::integer) values[i] = int(list->items[i].integer);
    return values;
}

}  // namespace aftershade
