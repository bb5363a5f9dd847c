/* One library per CASE_..., each wrong (or right) in one way; tests/CMakeLists.txt builds them. */
#include <stdlib.h>
#include <unistd.h>

#include "aftershade_plugin.h"
#include "crash.h"

#ifndef CASE_ID
#define CASE_ID "case"
#endif
#ifndef CASE_MAJOR
#define CASE_MAJOR AFTERSHADE_ABI_MAJOR
#endif
#ifndef CASE_LIBRARY_SIZE
#define CASE_LIBRARY_SIZE sizeof(aftershade_library)
#endif
#ifndef CASE_PREPARE
#define CASE_PREPARE
#endif
#ifndef CASE_GAIN
#define CASE_GAIN gain * frame->number
#endif
#ifndef CASE_DESTROY
#define CASE_DESTROY
#endif
#ifndef CASE_FACTORY
#define CASE_FACTORY &the_factory
#endif

static aftershade_status prepare(const aftershade_instance *instance, const aftershade_frame *frame,
                                 const aftershade_output *output) {
    double gain = 0;
    (void)instance;
    CASE_PREPARE;
    frame->params->get_float(frame->params, "gain", &gain);
    const float value = (float)(CASE_GAIN);
    return output->set_float(output, "gain", &value, 1);
}

static void destroy(const aftershade_instance *instance) {
    (void)instance;
    CASE_DESTROY;
}

static const aftershade_instance the_instance = {
    .struct_size = sizeof(aftershade_instance), .destroy = destroy, .prepare = prepare};

static const aftershade_instance *create(const aftershade_factory *factory, const aftershade_host *host,
                                         const char *step) {
    (void)factory, (void)host, (void)step;
    return &the_instance;
}


static const aftershade_factory the_factory __attribute__((unused)) = {.struct_size = sizeof(aftershade_factory),
                                        .effect_id = CASE_ID,
                                        .effect_version = "1.0.0",
                                        .create = create};

static const aftershade_factory *get_factory(uint32_t index) {
    (void)index;
    return CASE_FACTORY;
}

#ifdef CASE_NEWER
/* As a host of a later minor would see it: more fields than this header has. */
const struct {
    aftershade_library known;
    void *later[4];
} aftershade_library_entry_newer __asm__("aftershade_library_entry") __attribute__((visibility("default"))) = {
    {.struct_size = sizeof(aftershade_library) + 4 * sizeof(void *),
     .abi_major = AFTERSHADE_ABI_MAJOR,
     .abi_minor = AFTERSHADE_ABI_MINOR + 7,
     .name = "case",
     .version = "1.0.0",
     .factory_count = 1,
     .get_factory = get_factory},
    {(void *)1, (void *)1, (void *)1, (void *)1}};
#else
const aftershade_library AFTERSHADE_LIBRARY_ENTRY = {.struct_size = CASE_LIBRARY_SIZE,
                                                     .abi_major = CASE_MAJOR,
                                                     .abi_minor = AFTERSHADE_ABI_MINOR,
                                                     .name = "case",
                                                     .version = "1.0.0",
                                                     .factory_count = 1,
                                                     .get_factory = get_factory};
#endif
