// What each address of the page's server gives.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "framework/capture/capture.h"
#include "framework/capture/sequence.h"
#include "framework/effect/registry.h"
#include "framework/serve/http_message.h"
#include "framework/serve/look_model.h"
#include "framework/serve/render_thread.h"

namespace aftershade::serve {

/// [refers to what the caller keeps]
struct PageSetup {
    LookModel& look;
    RenderThread& pictures;
    const Sequence& sequence;
    const CaptureHeader& header;  ///< of the first frame
    std::string capture;          ///< as the user named it
    std::string effects;          ///< JSON: what `describe --json` gives for each
};

/// [any thread]
class PageServer {
public:
    explicit PageServer(PageSetup setup) : setup_(std::move(setup)) {}

    /// Of a request that the guards let through, to an address below /api/.
    Response answer(const Request& request);

private:
    Response state() const;
    Response change(const Request& request);
    Response picture(const Request& request);
    Response probe(const Request& request);
    Response histogram(const Request& request);
    Response command() const;
    PictureRequest request_of(const Request& request) const;

    PageSetup setup_;
};

/// All effects as JSON; one with faults is left out.
std::string describe_effects(EffectRegistry& effects);

}  // namespace aftershade::serve
