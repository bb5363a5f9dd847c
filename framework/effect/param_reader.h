// Parameters as the form of a step's passes and shaders depends on them.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>

#include "framework/core/param.h"

namespace aftershade {

/// What may be asked of a parameter's value: all of it, or of one that shaders look up by object only what
/// decides sizes and text. Contents of tables, curves and profiles change without a new graph.
enum class ParamAspect {
    value,
    table_entries,  ///< int: as table_entries()
    profile_count,  ///< int: different profiles of a scattering_profile
    is_burley       ///< bool: as is_burley()
};

/// The answer, of the type that the aspect says.
ParamValue aspect_of(const ParamValue& value, ParamAspect aspect);

/// Reads the parameters of one step and notes what it read. Graphs, passes and shaders are made through this
/// alone, so that the notes say when they must be made again. [refers to what the caller keeps]
class ParamReader {
public:
    using Note = std::function<void(const std::string& name, ParamAspect aspect, const ParamValue& answer)>;

    /// Of a text that no value decides: nothing may be read.
    ParamReader() = default;
    /// Without notes. Implicit: most readers of a ParamSet build no graph.
    ParamReader(const ParamSet& params) : params_(&params) {}
    ParamReader(const ParamSet& params, Note note) : params_(&params), note_(std::move(note)) {}

    bool has(const std::string& name) const { return params_ && params_->has(name); }
    /// The whole value.
    const ParamValue& get(const std::string& name) const;
    /// Of a table, objects or a scattering_profile.
    std::size_t table_entries(const std::string& name) const;
    /// Of a scattering_profile.
    int profile_count(const std::string& name) const;
    bool is_burley(const std::string& name) const;

private:
    ParamValue ask(const std::string& name, ParamAspect aspect) const;

    const ParamSet* params_ = nullptr;
    Note note_;
};

}  // namespace aftershade
