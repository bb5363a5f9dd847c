// Errors of the host API as exceptions of the package.
#pragma once

namespace aftershade::python {

/// From now on Error becomes what aftershade._errors.exception makes of it.
void translate_errors();

}  // namespace aftershade::python
