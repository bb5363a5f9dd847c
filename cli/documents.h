// The documents that users write, for the verbs that speak of all of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "framework/document/grammar_table.h"

namespace aftershade::cli {

struct Document {
    std::string name;  ///< as `aftershade schema` takes it
    /// JSON Schema; a look's lists the effects of these folders and the shipped ones.
    std::function<std::string(const std::vector<std::string>& effect_paths)> schema;
    /// What the docs have tables of, "<name>.<block>", and of the blocks that these refer to.
    std::vector<const grammar::Block*> blocks = {};
};

const std::vector<Document>& documents();
std::vector<std::string> document_names();
/// The tables of all documents.
grammar::Tables document_tables();

}  // namespace aftershade::cli
