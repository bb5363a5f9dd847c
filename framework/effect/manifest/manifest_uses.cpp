// What a pass of a manifest reads and writes.
#include <algorithm>
#include <regex>
#include <utility>

#include "framework/effect/manifest/manifest_parser.h"

namespace aftershade {

namespace {

constexpr int kMaxLevel = 14;  // of 16384 texels a side

const std::vector<std::string> kFilters{"nearest", "linear"};
const std::vector<std::string> kOutside{"clamp", "weight_zero"};
const std::vector<std::string> kAccess{"read", "write", "atomic"};

/// "name.prev" is the last frame's: takes the end off and says whether it was there.
bool take_prev(std::string& name) {
    constexpr std::string_view kPrev = ".prev";
    if (!name.ends_with(kPrev)) return false;
    name.resize(name.size() - kPrev.size());
    return true;
}

/// "*": all else that the text names.
bool is_the_rest(const Node& item) {
    return item.is_string() && item.string == "*";
}

}  // namespace

bool ManifestParser::reads(const Node& owner, ObjectReader& reader, std::vector<ReadSpec>& reads) {
    bool infers = !owner.find("reads");
    if (const Node* section = reader.array("reads"))
        for (const Node& item : section->items) {
            if (is_the_rest(item)) infers = true;
            else reads.push_back(read(item));
        }
    return infers;
}

bool ManifestParser::writes(const Node& owner, ObjectReader& reader, std::vector<WriteSpec>& writes) {
    bool infers = !owner.find("writes");
    if (const Node* section = reader.array("writes"))
        for (const Node& item : section->items) {
            if (is_the_rest(item)) infers = true;
            else writes.push_back(write(item));
        }
    return infers;
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
        if (const Node* section = reader.object("when")) add_conditions(*section, read.when);
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
        if (const Node* section = reader.object("when")) add_conditions(*section, write.when);
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

}  // namespace aftershade
