#include "framework/effect/param_reader.h"

namespace aftershade {

namespace {

bool is_another_than_0(const ParamValue& number) {
    const auto* integer = std::get_if<std::int64_t>(&number);
    return integer ? *integer != 0 : std::get<double>(number) != 0;
}

}  // namespace

ParamValue aspect_of(const ParamSpec& spec, const ParamValue& value, ParamAspect aspect) {
    switch (aspect) {
        case ParamAspect::value: break;
        case ParamAspect::table_entries: return std::int64_t(spec.type->table->entries(value));
        case ParamAspect::texture_size: {
            const TexelSize size = spec.type->texture->size(value);
            return std::vector<double>{double(size.width), double(size.height), double(size.channels)};
        }
        case ParamAspect::defines: return spec.type->defines(spec, value);
        case ParamAspect::is_nonzero: return is_another_than_0(value);
        case ParamAspect::is_changed: return value != spec.identity;
    }
    return value;
}

const ParamValue& ParamReader::get(const std::string& name) const {
    const ParamValue& value = params_->get(name);
    if (note_) note_(name, ParamAspect::value, value);
    return value;
}

std::size_t ParamReader::table_entries(const ParamSpec& spec) const {
    return std::size_t(std::get<std::int64_t>(ask(spec, ParamAspect::table_entries)));
}

TexelSize ParamReader::texture_size(const ParamSpec& spec) const {
    const auto answer = std::get<std::vector<double>>(ask(spec, ParamAspect::texture_size));
    return {int(answer[0]), int(answer[1]), int(answer[2])};
}

std::string ParamReader::defines(const ParamSpec& spec) const {
    return std::get<std::string>(ask(spec, ParamAspect::defines));
}

bool ParamReader::is_nonzero(const std::string& name) const {
    return std::get<bool>(noted(name, ParamAspect::is_nonzero, is_another_than_0(params_->get(name))));
}

bool ParamReader::is_changed(const std::string& name, const ParamValue& identity) const {
    return std::get<bool>(noted(name, ParamAspect::is_changed, params_->get(name) != identity));
}

ParamValue ParamReader::ask(const ParamSpec& spec, ParamAspect aspect) const {
    return noted(spec.name, aspect, aspect_of(spec, params_->get(spec.name), aspect));
}

ParamValue ParamReader::noted(const std::string& name, ParamAspect aspect, ParamValue answer) const {
    if (note_) note_(name, aspect, answer);
    return answer;
}

}  // namespace aftershade
