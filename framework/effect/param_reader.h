// Parameters as the form of a step's passes and shaders depends on them.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>

#include "framework/document/param_type.h"

namespace aftershade {

/// The readable part of a parameter's value: all of it. For a value that reaches shaders through a texture or
/// a storage block, only the part that decides sizes and text. Contents of tables, curves and profiles change
/// without a new graph.
enum class ParamAspect {
    value,
    table_entries,  ///< int: entries of its table
    texture_size,   ///< vector: width, height and channels of its texture
    defines,        ///< string: its preprocessor lines
    is_nonzero,     ///< bool: of one number, whether it is another than 0
    is_changed      ///< bool: whether it is another than the parameter's `identity`
};

/// The answer, of the type that the aspect says. The parameter's type must have that.
ParamValue aspect_of(const ParamSpec& spec, const ParamValue& value, ParamAspect aspect);

/// Reads the parameters of one step and notes what it read. Graphs, passes and shaders are made through this
/// alone, so that the notes say when they must be made again. [refers to what the caller keeps]
class ParamReader {
public:
    using Note = std::function<void(const std::string& name, ParamAspect aspect, const ParamValue& answer)>;

    /// A reader for texts that depend on no value: it may read none.
    ParamReader() = default;
    /// Without notes. Implicit: most readers of a ParamSet build no graph.
    ParamReader(const ParamSet& params) : params_(&params) {}
    ParamReader(const ParamSet& params, Note note) : params_(&params), note_(std::move(note)) {}

    bool has(const std::string& name) const { return params_ && params_->has(name); }
    /// The whole value.
    const ParamValue& get(const std::string& name) const;
    /// Entries of the table, for a type with a table.
    std::size_t table_entries(const ParamSpec& spec) const;
    /// Size of the texture, for a type with a texture.
    TexelSize texture_size(const ParamSpec& spec) const;
    /// Preprocessor lines, for a type with such lines.
    std::string defines(const ParamSpec& spec) const;
    /// Whether one number is not 0.
    bool is_nonzero(const std::string& name) const;
    /// Whether the value is another than this one, which is the parameter's `identity`.
    bool is_changed(const std::string& name, const ParamValue& identity) const;

private:
    ParamValue ask(const ParamSpec& spec, ParamAspect aspect) const;
    ParamValue noted(const std::string& name, ParamAspect aspect, ParamValue answer) const;

    const ParamSet* params_ = nullptr;
    Note note_;
};

}  // namespace aftershade
