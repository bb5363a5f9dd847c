#include "convert.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <type_traits>
#include <variant>
#include <vector>

namespace aftershade::python {

namespace {

bool is_number(nb::handle object) {
    return nb::isinstance<nb::int_>(object) || nb::isinstance<nb::float_>(object);
}

bool is_row_of_numbers(nb::handle object) {
    if (!nb::isinstance<nb::list>(object) && !nb::isinstance<nb::tuple>(object)) return false;
    for (nb::handle item : object)
        if (!is_number(item) || nb::isinstance<nb::bool_>(item)) return false;
    return true;
}

std::string json_of(nb::handle object) {
    return nb::cast<std::string>(nb::module_::import_("json").attr("dumps")(object));
}

}  // namespace

api::Value value_from(nb::handle object) {
    if (nb::isinstance<nb::bool_>(object)) return nb::cast<bool>(object);
    if (nb::isinstance<nb::int_>(object)) return nb::cast<std::int64_t>(object);
    if (nb::isinstance<nb::float_>(object)) return nb::cast<double>(object);
    if (nb::isinstance<nb::str>(object)) return nb::cast<std::string>(object);
    if (is_row_of_numbers(object)) return nb::cast<std::vector<double>>(object);
    // NumPy's scalars and arrays have Python's numbers and lists.
    if (nb::hasattr(object, "tolist")) return value_from(object.attr("tolist")());
    return api::Json{json_of(object)};
}

nb::object value_to(const api::Value& value) {
    return std::visit(
        [](const auto& held) -> nb::object {
            if constexpr (std::is_same_v<std::decay_t<decltype(held)>, api::Json>)
                return nb::module_::import_("json").attr("loads")(held.text);
            else return nb::cast(held);
        },
        value);
}

api::ArrayView view_from(const InputArray& array) {
    api::ArrayView view;
    if (array.dtype() == nb::dtype<float>()) view.type = api::ElementType::float32;
    else if (array.dtype() == nb::dtype<std::uint32_t>()) view.type = api::ElementType::uint32;
    else throw nb::type_error("the array's dtype must be float32, or uint32 for ids");
    if (array.ndim() != 2 && array.ndim() != 3)
        throw nb::value_error("the array must have the shape (height, width) or (height, width, channels)");
    view.data = array.data();
    view.height = int(array.shape(0));
    view.width = int(array.shape(1));
    view.channels = array.ndim() == 3 ? int(array.shape(2)) : 1;
    const bool channels_are_close = array.ndim() == 2 || array.shape(2) == 1 || array.stride(2) == 1;
    const bool pixels_are_close = array.shape(1) == 1 || array.stride(1) == view.channels;
    if (!channels_are_close || !pixels_are_close)
        throw nb::value_error(
            "the array's pixels must lie side by side, as numpy.ascontiguousarray makes them");
    view.row_stride = array.shape(0) == 1 ? 0 : std::ptrdiff_t(array.stride(0)) * 4;
    return view;
}

nb::object array_from(const api::Image& image) {
    auto* keeper = new api::Image(image);
    const nb::capsule owner(keeper, [](void* kept) noexcept { delete static_cast<api::Image*>(kept); });
    const std::size_t shape[] = {std::size_t(image.height()), std::size_t(image.width()),
                                 std::size_t(image.channels())};
    const std::size_t dimensions = image.channels() == 1 ? 2 : 3;
    if (image.type() == api::ElementType::uint32)
        return nb::cast(nb::ndarray<nb::numpy, const std::uint32_t>(image.data(), dimensions, shape, owner));
    return nb::cast(nb::ndarray<nb::numpy, const float>(image.data(), dimensions, shape, owner));
}

nb::dict diagnostic_to(const api::Diagnostic& diagnostic) {
    nb::dict result;
    result["severity"] = diagnostic.severity == api::Severity::error ? "error" : "warning";
    result["message"] = diagnostic.message;
    result["file"] = diagnostic.file;
    result["line"] = diagnostic.line;
    result["column"] = diagnostic.column;
    return result;
}

}  // namespace aftershade::python
