#include "cli/documents.h"

#include <iostream>
#include <utility>

#include "cli/capture_options.h"
#include "cli/effect_options.h"
#include "framework/base/data_path.h"
#include "framework/capture/capture_grammar.h"
#include "framework/capture/profile.h"
#include "framework/capture/profile_grammar.h"
#include "framework/document/schema_pieces.h"
#include "framework/effect/manifest/manifest_grammar.h"
#include "framework/golden/golden_grammar.h"
#include "framework/golden/golden_suite.h"
#include "framework/image/role.h"
#include "framework/look/look_grammar.h"
#include "framework/look/look_schema.h"
#include "framework/scattering/scattering_grammar.h"
#include "framework/scene/scene_schema.h"

namespace aftershade::cli {

namespace {

std::string schema_of_looks(const std::vector<std::string>& effect_paths) {
    Diagnostics diagnostics;
    EffectRegistry effects = find_effects(effect_paths, diagnostics);
    std::vector<const EffectManifest*> manifests;
    for (const std::string& id : effects.ids())
        if (const EffectManifest* manifest = effects.find(id, diagnostics)) manifests.push_back(manifest);
    stop_at_errors(diagnostics);
    diagnostics.print(std::cerr);
    return look_schema(manifests);
}

std::string roles_of(const Profile& profile) {
    std::string text;
    for (const std::string& role : role_names())
        if (profile.roles.contains(role)) text += (text.empty() ? "`" : ", `") + role + "`";
    return text;
}

std::string real_files_of(const Profile& profile) {
    std::string text;
    for (const std::string& file : profile.seen_on) text += (text.empty() ? "`" : ", `") + file + "`";
    return text.empty() ? "**none**" : text;
}

/// What the shipped profiles say of themselves.
grammar::Tables tables_of_profiles() {
    std::string shipped = "| profile | producer | roles | seen on real files |\n|---|---|---|---|\n";
    std::string facts = "| profile | fact | verified on | source |\n|---|---|---|---|\n";
    Diagnostics diagnostics;
    for (const Profile& profile : read_profiles(data_path() / "profiles", diagnostics)) {
        shipped += "| `" + profile.id + "` | " + profile.summary + " | " + roles_of(profile) + " | " +
                   real_files_of(profile) + " |\n";
        for (const ProfileFact& fact : profile.facts)
            facts += "| `" + profile.id + "` | " + fact.fact + " | " +
                     (fact.verified.empty() ? "**no**" : fact.verified) + " | " + fact.source + " |\n";
    }
    stop_at_errors(diagnostics);
    return {{"profiles.shipped", shipped}, {"profiles.facts", facts}};
}

/// Of a document whose schema is the same everywhere.
auto schema_by(std::string (*schema)()) {
    return [schema](const std::vector<std::string>&) { return schema(); };
}

}  // namespace

const std::vector<Document>& documents() {
    static const std::vector<Document> all = {
        {"look", schema_of_looks, {&look_block(), &look_step_block(), &look_use_block()}},
        {"capture", schema_by(capture_schema), {&capture_block(), &decoding_table()}},
        {"effect", schema_by(effect_schema), {&effect_block(), &group_block()}},
        {"module", schema_by(module_schema), {&module_block()}},
        {"scene", schema_by(scene::scene_schema)},  // its tables are a page: scene-reference.md
        {"profile", schema_by(profile_schema), {&profile_block()}},
        {"scattering_profile", schema_by(scattering_profile_schema), {&scattering_profile_block()}},
        {"golden", schema_by(golden_schema), {&golden_suite_block()}},
        {"case", schema_by(effect_case_schema), {&effect_case_block()}}};
    return all;
}

std::vector<std::string> document_names() {
    std::vector<std::string> names;
    for (const Document& document : documents()) names.push_back(document.name);
    return names;
}

grammar::Tables document_tables() {
    grammar::Tables tables = tables_of_profiles();
    std::vector<std::pair<std::string, const grammar::Block*>> blocks;
    for (const Document& document : documents())
        for (const grammar::Block* block : document.blocks) blocks.emplace_back(document.name, block);
    tables.merge(grammar::tables_of(blocks));
    return tables;
}

}  // namespace aftershade::cli
