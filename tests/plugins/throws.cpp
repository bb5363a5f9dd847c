// A library whose prepare throws through the C ABI, against the rules.
#include <stdexcept>

#include "aftershade_plugin.h"

namespace {

aftershade_status prepare(const aftershade_instance*, const aftershade_frame*, const aftershade_output*) {
    throw std::runtime_error("no luck today");
}

const aftershade_instance kInstance = {
    sizeof(aftershade_instance), nullptr, [](const aftershade_instance*) {}, prepare, nullptr, nullptr};
const aftershade_factory kFactory = {
    sizeof(aftershade_factory), "throws", "1.0.0",
    [](const aftershade_factory*, const aftershade_host*, const char*) { return &kInstance; }};

}  // namespace

const aftershade_library AFTERSHADE_LIBRARY_ENTRY = {sizeof(aftershade_library),
                                                     AFTERSHADE_ABI_MAJOR,
                                                     AFTERSHADE_ABI_MINOR,
                                                     "throws",
                                                     "1.0.0",
                                                     nullptr,
                                                     nullptr,
                                                     1,
                                                     [](uint32_t) { return &kFactory; },
                                                     nullptr,
                                                     nullptr};
