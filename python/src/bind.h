// The parts of the module; each adds its classes and functions.
#pragma once

#include <nanobind/nanobind.h>

namespace aftershade::python {

void bind_host(nanobind::module_& module);
void bind_capture(nanobind::module_& module);
void bind_look(nanobind::module_& module);
void bind_compare(nanobind::module_& module);
void bind_velocity(nanobind::module_& module);

}  // namespace aftershade::python
