#include "framework/serve/handover.h"

#include <nlohmann/json.hpp>

#include "framework/core/error.h"

namespace aftershade::serve {

using Json = nlohmann::ordered_json;

// CBOR (RFC 8949), because a look's text need not be UTF-8.
std::string handover_bytes(const Handover& handover) {
    const LookHistory& look = handover.look;
    const Json json = {{"port", handover.port},
                       {"token", handover.token},
                       {"texts", look.texts},
                       {"at", look.at},
                       {"saved_text", look.saved_text},
                       {"revision", look.revision},
                       {"saved_revision", look.saved_revision},
                       {"effects_revision", look.effects_revision},
                       {"hung_text", handover.hung.text},
                       {"hung_reason", handover.hung.reason}};
    std::string bytes;
    Json::to_cbor(json, bytes);
    return bytes;
}

Handover read_handover(const std::string& bytes) {
    try {
        const Json json = Json::from_cbor(bytes);
        Handover handover;
        json.at("port").get_to(handover.port);
        json.at("token").get_to(handover.token);
        json.at("texts").get_to(handover.look.texts);
        json.at("at").get_to(handover.look.at);
        json.at("saved_text").get_to(handover.look.saved_text);
        json.at("revision").get_to(handover.look.revision);
        json.at("saved_revision").get_to(handover.look.saved_revision);
        json.at("effects_revision").get_to(handover.look.effects_revision);
        json.at("hung_text").get_to(handover.hung.text);
        json.at("hung_reason").get_to(handover.hung.reason);
        if (handover.look.at < handover.look.texts.size()) return handover;
    } catch (const Json::exception&) {
        // reported below
    }
    throw Error(ExitCode::usage, "the state of the server before this one cannot be read");
}

}  // namespace aftershade::serve
