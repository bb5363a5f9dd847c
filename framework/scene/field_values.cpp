#include "framework/scene/fields.h"

namespace aftershade::scene {

namespace {

/// Among grammar::interpolation_names().
constexpr Interpolation kInterpolations[] = {Interpolation::linear, Interpolation::step,
                                             Interpolation::smooth};

template <class T, class Make>
Animated<T> animated(const grammar::Keyed& value, Make&& make) {
    std::vector<typename Animated<T>::Key> keys;
    for (std::size_t i = 0; i < value.frames.size(); ++i)
        keys.push_back({value.frames[i], make(value.values[i])});
    return {std::move(keys), kInterpolations[value.interpolation]};
}

glm::dvec3 vec3_of(const std::vector<double>& numbers) {
    return {numbers.at(0), numbers.at(1), numbers.at(2)};
}

}  // namespace

glm::dvec2 vec2(const grammar::Reader& reader, std::string_view key) {
    const std::vector<double> numbers = reader.components(key);
    return {numbers.at(0), numbers.at(1)};
}

glm::dvec3 vec3(const grammar::Reader& reader, std::string_view key) {
    return vec3_of(reader.components(key));
}

double number(const grammar::Reader& reader, std::string_view key) {
    return reader.components(key).at(0);
}

int integer(const grammar::Reader& reader, std::string_view key) {
    return int(number(reader, key));
}

bool flag(const grammar::Reader& reader, std::string_view key) {
    return number(reader, key) != 0;
}

Animated<double> animated_number(const grammar::Reader& reader, std::string_view key) {
    return animated<double>(reader.keyed(key),
                            [](const std::vector<double>& numbers) { return numbers.at(0); });
}

Animated<glm::dvec3> animated_vec3(const grammar::Reader& reader, std::string_view key) {
    return animated<glm::dvec3>(reader.keyed(key), vec3_of);
}

}  // namespace aftershade::scene
