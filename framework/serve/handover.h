// What a server gives to the one that replaces it when a pass does not come to an end.
#pragma once

#include <string>

#include "framework/serve/look_model.h"

namespace aftershade::serve {

struct Handover {
    int port = 0;
    std::string token;
    LookHistory look;
    HungText hung;
};

std::string handover_bytes(const Handover& handover);
/// Of what handover_bytes() gave. Throws Error(ExitCode::usage) for anything else.
Handover read_handover(const std::string& bytes);

}  // namespace aftershade::serve
