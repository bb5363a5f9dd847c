// Values, images and diagnostics between Python and the host API.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <string>

#include "aftershade/host.h"

namespace aftershade::python {

namespace nb = nanobind;
namespace api = aftershade::host;

/// An array whose pixels are interleaved and whose rows may have padding: (height, width) or (height, width,
/// channels).
using InputArray = nb::ndarray<nb::ro, nb::device::cpu>;

/// A number, text, a list of numbers; anything else as JSON. Throws nb::type_error for what JSON has no form
/// for.
api::Value value_from(nb::handle object);
nb::object value_to(const api::Value& value);

/// Throws nb::type_error for other types than float32 and uint32, nb::value_error for other dimensions and
/// for pixels with gaps.
api::ArrayView view_from(const InputArray& array);
/// (height, width) of one channel, else (height, width, channels). It shares the image's pixels, keeps them
/// alive, and is read-only.
nb::object array_from(const api::Image& image);

/// {"message", "file", "line", "column", "severity"}.
nb::dict diagnostic_to(const api::Diagnostic& diagnostic);

/// The fields of a parameter by their names; "from" is "from_", since Python has a word `from`.
nb::dict param_to(const api::ParamInfo& info);

/// A camera from and to its dict: the keys are the fields of host::Camera. Throws nb::type_error naming a key
/// that it does not have.
api::Camera camera_from(const nb::dict& fields);
nb::dict camera_to(const api::Camera& camera);

}  // namespace aftershade::python
