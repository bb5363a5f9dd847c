// The extension behind the package `aftershade`; docs/python.md is for its users.
#include <nanobind/nanobind.h>

#include "bind.h"
#include "errors.h"

NB_MODULE(_native, module) {
    module.doc() = "Aftershade's host API. Import aftershade, which makes Python's objects of it.";
    aftershade::python::translate_errors();
    aftershade::python::bind_host(module);
    aftershade::python::bind_capture(module);
    aftershade::python::bind_look(module);
    aftershade::python::bind_compare(module);
    aftershade::python::bind_velocity(module);
}
