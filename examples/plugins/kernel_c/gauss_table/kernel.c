/* Fills the table `kernel` with a Gaussian: the smallest whole plug-in. */
#include <math.h>

#include "aftershade_plugin.h"

enum { MAX_RADIUS = 32 };

static aftershade_status prepare(const aftershade_instance *instance, const aftershade_frame *frame,
                                 const aftershade_output *output) {
    double sigma = 1.0;
    float kernel[2 * MAX_RADIUS + 1];
    double sum = 0.0;
    (void)instance;
    frame->params->get_float(frame->params, "sigma", &sigma);
    int32_t radius = (int32_t)ceil(3.0 * sigma);
    if (radius > MAX_RADIUS) radius = MAX_RADIUS;
    for (int32_t i = -radius; i <= radius; ++i) sum += exp(-0.5 * (i / sigma) * (i / sigma));
    for (int32_t i = -radius; i <= radius; ++i)
        kernel[i + radius] = (float)(exp(-0.5 * (i / sigma) * (i / sigma)) / sum);
    const uint32_t count = (uint32_t)(2 * radius + 1);
    output->set_int(output, "radius", &radius, 1);
    output->set_table(output, "kernel", AFTERSHADE_FLOAT, count, 1, kernel, count * sizeof(float));
    output->set_overscan(output, radius);
    return AFTERSHADE_OK;
}

/* Nothing is kept between frames, so that one constant instance serves every step. */
static void destroy(const aftershade_instance *instance) {
    (void)instance;
}

static const aftershade_instance the_instance = {
    .struct_size = sizeof(aftershade_instance), .destroy = destroy, .prepare = prepare};

static const aftershade_instance *create(const aftershade_factory *factory, const aftershade_host *host,
                                         const char *step) {
    (void)factory, (void)host, (void)step;
    return &the_instance;
}

static const aftershade_factory the_factory = {.struct_size = sizeof(aftershade_factory),
                                               .effect_id = "gauss_table",
                                               .effect_version = "1.0.0",
                                               .create = create};

static const aftershade_factory *get_factory(uint32_t index) {
    (void)index;
    return &the_factory;
}

const aftershade_library AFTERSHADE_LIBRARY_ENTRY = {.struct_size = sizeof(aftershade_library),
                                                     .abi_major = AFTERSHADE_ABI_MAJOR,
                                                     .abi_minor = AFTERSHADE_ABI_MINOR,
                                                     .name = "kernel_c",
                                                     .version = "1.0.0",
                                                     .factory_count = 1,
                                                     .get_factory = get_factory};
