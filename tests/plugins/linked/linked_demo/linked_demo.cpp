// Native code that is linked into the program, as a shipped effect's is: it includes the C header alone.
#include "aftershade_plugin.h"

namespace {

aftershade_status prepare(const aftershade_instance*, const aftershade_frame* frame,
                          const aftershade_output* output) {
    const float number = float(frame->number);
    return output->set_float(output, "gain", &number, 1);
}

const aftershade_instance kInstance = {
    sizeof(aftershade_instance), nullptr, [](const aftershade_instance*) {}, prepare, nullptr, nullptr};
const aftershade_factory kFactory = {
    sizeof(aftershade_factory), "linked_demo", "1.0.0",
    [](const aftershade_factory*, const aftershade_host*, const char*) { return &kInstance; }};

}  // namespace

const aftershade_library AFTERSHADE_LIBRARY_ENTRY = {sizeof(aftershade_library),
                                                     AFTERSHADE_ABI_MAJOR,
                                                     AFTERSHADE_ABI_MINOR,
                                                     "linked",
                                                     "1.0.0",
                                                     nullptr,
                                                     nullptr,
                                                     1,
                                                     [](uint32_t) { return &kFactory; },
                                                     nullptr,
                                                     nullptr};
