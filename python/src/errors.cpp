#include "errors.h"

#include <exception>

#include "convert.h"

namespace aftershade::python {

namespace {

void raise(const api::Error& error) {
    nb::list diagnostics;
    for (const api::Diagnostic& diagnostic : error.diagnostics())
        diagnostics.append(diagnostic_to(diagnostic));
    const nb::object exception =
        nb::module_::import_("aftershade._errors")
            .attr("exception")(api::error_kind_name(error.kind()), error.what(), diagnostics);
    PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(exception.ptr())), exception.ptr());
}

}  // namespace

void translate_errors() {
    nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
        try {
            std::rethrow_exception(thrown);
        } catch (const api::Error& error) {
            raise(error);
        }
    });
}

}  // namespace aftershade::python
