#include "framework/effect/param_reader.h"

#include "framework/effect/param_resources.h"

namespace aftershade {

ParamValue aspect_of(const ParamValue& value, ParamAspect aspect) {
    switch (aspect) {
        case ParamAspect::value: break;
        case ParamAspect::table_entries: return std::int64_t(table_entries(value));
        case ParamAspect::profile_count:
            return std::int64_t(scattering_profiles_of(std::get<ScatteringValue>(value)).size());
        case ParamAspect::is_burley: return is_burley(std::get<ScatteringValue>(value));
    }
    return value;
}

const ParamValue& ParamReader::get(const std::string& name) const {
    const ParamValue& value = params_->get(name);
    if (note_) note_(name, ParamAspect::value, value);
    return value;
}

std::size_t ParamReader::table_entries(const std::string& name) const {
    return std::size_t(std::get<std::int64_t>(ask(name, ParamAspect::table_entries)));
}

int ParamReader::profile_count(const std::string& name) const {
    return int(std::get<std::int64_t>(ask(name, ParamAspect::profile_count)));
}

bool ParamReader::is_burley(const std::string& name) const {
    return std::get<bool>(ask(name, ParamAspect::is_burley));
}

ParamValue ParamReader::ask(const std::string& name, ParamAspect aspect) const {
    ParamValue answer = aspect_of(params_->get(name), aspect);
    if (note_) note_(name, aspect, answer);
    return answer;
}

}  // namespace aftershade
