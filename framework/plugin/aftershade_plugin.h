/* The native plug-in ABI of Aftershade: C11, and C++ as it stands. This header is all that a plug-in needs.
 *
 * A plug-in is a shared library that offers native effects. A native effect is the part of an effect that
 * GLSL cannot do well: once a frame the host calls its `prepare`, which computes what the effect's
 * effect.json declares under "native" (uniforms and tables) and decides how often passes run. The host draws.
 *
 * Rationale: a plug-in gets no GL and no pixels, so that it can leak no GL state, cannot depend on a backend,
 * and what it does can be checked against its declaration.
 *
 * One symbol is exported, `aftershade_library_entry`:
 *
 *     const aftershade_library AFTERSHADE_LIBRARY_ENTRY = {
 *         .struct_size = sizeof(aftershade_library),
 *         .abi_major = AFTERSHADE_ABI_MAJOR, .abi_minor = AFTERSHADE_ABI_MINOR,
 *         .name = "gauss", .version = "1.0.0", .factory_count = 1, .get_factory = get_factory };
 *
 * Versions. Every struct begins with its size as its author's compiler saw it. A new MINOR appends fields to
 * structs and never changes older ones: the host takes libraries of older minors (fields that they lack count
 * as absent) and of newer ones (the host ignores fields that it lacks). A new MAJOR may change
 * anything but the first three fields of aftershade_library; the host refuses a library of another major.
 * A plug-in that uses a field newer than 1.0 of a struct that the host filled checks AFTERSHADE_HAS first.
 *
 * Threads, in brackets after each function:
 * - [library] one call at a time for one library
 * - [instance] one call at a time for one instance, not always from the same thread; other instances of the
 *   library may be busy at the same time, so anything shared between instances needs a lock
 * - [prepare] only inside `prepare`, on the thread that called it
 * - [thread-safe] any time from any thread, until the lifetime of the object ends
 *
 * Lifetimes. What the host hands to `prepare` is valid until `prepare` returns; the aftershade_host that
 * `create` got, until `destroy` returns. Strings and arrays that a plug-in hands to a host function are
 * copied before that function returns. What a plug-in returns by pointer (descriptors, instances, their
 * strings) stays valid as stated there.
 *
 * All strings are UTF-8 and end with 0. No function of a plug-in may throw; the host catches a C++ exception
 * and reports it as a fault of the plug-in, but what was being built is lost. A plug-in must not call exit or
 * setlocale, and must not change signal handlers: the process is not its own.
 */
#ifndef AFTERSHADE_PLUGIN_H
#define AFTERSHADE_PLUGIN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define AFTERSHADE_ABI_MAJOR 1
#define AFTERSHADE_ABI_MINOR 1

#ifdef __cplusplus
#define AFTERSHADE_DECLARE extern "C"
#else
#define AFTERSHADE_DECLARE extern
#endif

#define AFTERSHADE_EXPORT __attribute__((visibility("default")))

/* Whether the struct at `pointer`, a `type`, was filled by someone who knew `field`. */
#define AFTERSHADE_HAS(pointer, type, field) \
    ((pointer)->struct_size >= offsetof(type, field) + sizeof((pointer)->field))

/* The widest and highest table, texels. */
#define AFTERSHADE_MAX_TABLE_SIDE 1024

/* Rationale: fixed-width integers, because the size of a C enum is the compiler's choice. */
typedef int32_t aftershade_status;
enum {
    AFTERSHADE_OK = 0,
    AFTERSHADE_FAILED = 1,       /* anything else; say what with aftershade_host.set_error */
    AFTERSHADE_UNKNOWN_NAME = 2, /* not declared in effect.json */
    AFTERSHADE_WRONG_TYPE = 3,   /* declared with another type or number of components */
    AFTERSHADE_OUT_OF_RANGE = 4, /* above a limit, NaN, or a pointer that is NULL */
    AFTERSHADE_OUT_OF_MEMORY = 5
};

typedef int32_t aftershade_log_level;
enum {
    AFTERSHADE_LOG_DEBUG = 0,
    AFTERSHADE_LOG_INFO = 1,
    AFTERSHADE_LOG_WARNING = 2,
    AFTERSHADE_LOG_ERROR = 3
};

/* Elements of tables, without padding: AFTERSHADE_VEC2 is two floats. */
typedef int32_t aftershade_element;
enum {
    AFTERSHADE_FLOAT = 0,
    AFTERSHADE_VEC2 = 1,
    AFTERSHADE_VEC4 = 2,
    AFTERSHADE_UINT = 3,
    AFTERSHADE_UVEC2 = 4,
    AFTERSHADE_UVEC4 = 5
};

/* What the host offers to everyone: logging, errors, extensions. */
typedef struct aftershade_host aftershade_host;
struct aftershade_host {
    uint32_t struct_size;
    uint32_t abi_major; /* the host's; a library runs only where it equals its own */
    uint32_t abi_minor;
    const char* name; /* "aftershade" */
    const char* version;
    void* host_data; /* the host's own */

    /* One line without a line end; shown with the effect's and the step's name. [thread-safe] */
    void (*log)(const aftershade_host* host, aftershade_log_level level, const char* message);

    /* Says why the function of the plug-in that runs now will fail. The last text counts. [instance] */
    void (*set_error)(const aftershade_host* host, const char* message);

    /* The struct of an extension by its id, or NULL where this host does not have it; it lives as long as the
     * host object.
     * Reserved: "aftershade.image/1", access to pixels from the CPU; NULL today. [thread-safe] */
    const void* (*get_extension)(const aftershade_host* host, const char* id);
};

/* The step's parameters, complete and within their ranges. Every getter fills *value and returns
 * AFTERSHADE_OK, or leaves it as it was. Asking for a parameter that effect.json does not declare, or with
 * another type, is a fault that makes `prepare` fail, whatever it returns. */
typedef struct aftershade_params aftershade_params;
struct aftershade_params {
    uint32_t struct_size;
    const void* host_data;

    /* Types float and angle, in the declared unit. [prepare] */
    aftershade_status (*get_float)(const aftershade_params* params, const char* name, double* value);
    /* [prepare] */
    aftershade_status (*get_int)(const aftershade_params* params, const char* name, int64_t* value);
    /* [prepare] */
    aftershade_status (*get_bool)(const aftershade_params* params, const char* name, bool* value);
    /* Types enum, as the word that the manifest lists, and text; valid until `prepare` returns. [prepare] */
    aftershade_status (*get_enum)(const aftershade_params* params, const char* name, const char** value);
    /* Types vec2, vec3, vec4 and color; `count` is 2, 3, 4 and 3. [prepare] */
    aftershade_status (*get_vector)(const aftershade_params* params, const char* name, double* values,
                                    uint32_t count);
    /* The declared unit, such as "m"; "" for a pure number; valid until `prepare` returns. [prepare] */
    aftershade_status (*get_unit)(const aftershade_params* params, const char* name, const char** unit);
};

/* What is known of the capture's camera. A value counts only where its `has_` is true. */
typedef struct aftershade_camera {
    uint32_t struct_size;
    bool has_focal_length;
    bool has_sensor_width;
    bool has_focus_distance;
    bool has_f_number;
    bool has_blades;
    bool has_rotation;
    bool has_view_from_world;
    bool has_clip_from_world;
    double focal_length_mm;
    double sensor_width_mm;
    double focus_distance_m; /* along the view axis */
    double f_number;
    double blades;       /* 0: a disk */
    double rotation_deg; /* 0: the middle of a straight edge at +x; positive turns +x towards +y (down) */
    double view_from_world[16]; /* row by row, acts on column vectors; looks along -z, y up, m */
    double clip_from_world[16]; /* the same way; after division x right and y up, -1 to 1 over the display
                                   window */
} aftershade_camera;

/* The text attributes of the capture's file. */
typedef struct aftershade_metadata aftershade_metadata;
struct aftershade_metadata {
    uint32_t struct_size;
    const void* host_data;

    /* NULL where there is none of that name, which is not a fault; valid until `prepare` returns. [prepare]
     */
    const char* (*get_text)(const aftershade_metadata* metadata, const char* name);
};

/* An input of the effect: described, not readable. */
typedef struct aftershade_image {
    uint32_t struct_size;
    bool present;     /* an optional input may be absent; then the sizes are 0 */
    const char* name; /* the input's, in effect.json */
    const char* role;
    uint32_t width_px;
    uint32_t height_px;
    uint32_t channels;
    uint32_t reserved; /* 0. Rationale: no struct ends in padding, or a field put there would seem present */
} aftershade_image;

/* One frame of one step. */
typedef struct aftershade_frame {
    uint32_t struct_size;
    int32_t number;
    double fps;        /* 0 where not known */
    uint32_t width_px; /* of the working grid: what passes are drawn on */
    uint32_t height_px;
    uint32_t display_width_px; /* pixels per millimetre on the sensor = this / sensor width, whatever the
                                  overscan */
    uint32_t display_height_px;
    bool history_valid; /* false in the first frame and after a cut */
    const aftershade_params* params;
    const aftershade_camera* camera;
    const aftershade_metadata* metadata;
    uint32_t image_count;
    /* Rationale: pointers rather than structs side by side, because the struct grows with the ABI's minor and
     * the distance between elements would be the host's, not the plug-in's. */
    const aftershade_image* const* images;

    /* since 1.1 */
    uint32_t step_seed; /* differs between the steps of a look; frame.step_seed in GLSL */
    uint32_t reserved;  /* 0, as above */
} aftershade_frame;

/* Takes what `prepare` computes. Everything is checked against effect.json; a refusal returns a status and is
 * kept by the host as a fault with its text, so that a plug-in need not check statuses: a fault makes
 * `prepare` fail, whatever it returns. Every declared uniform and table must be set in every frame; setting
 * one again replaces it.
 *
 * Rationale: frames are prepared in any order, by several processes; a value that is kept from the frame
 * before would depend on which process did that one. */
typedef struct aftershade_output aftershade_output;
struct aftershade_output {
    uint32_t struct_size;
    void* host_data;

    /* Declared as float, vec2, vec3 or vec4: `count` is 1 to 4. NaN is refused. [prepare] */
    aftershade_status (*set_float)(const aftershade_output* output, const char* name, const float* values,
                                   uint32_t count);
    /* int, ivec2, ivec3, ivec4. [prepare] */
    aftershade_status (*set_int)(const aftershade_output* output, const char* name, const int32_t* values,
                                 uint32_t count);
    /* uint, uvec2, uvec3, uvec4. [prepare] */
    aftershade_status (*set_uint)(const aftershade_output* output, const char* name, const uint32_t* values,
                                  uint32_t count);
    /* `width` x `height` elements row by row; an array has height 1. Each side from 1 to what effect.json
     * declares, which is AFTERSHADE_MAX_TABLE_SIDE at most; byte_count is width * height * size of the
     * element. NaN is refused. [prepare] */
    aftershade_status (*set_table)(const aftershade_output* output, const char* name,
                                   aftershade_element element, uint32_t width, uint32_t height,
                                   const void* data, size_t byte_count);
    /* How often a pass runs in this frame, 1 to 1000. [prepare] */
    aftershade_status (*set_repeat)(const aftershade_output* output, const char* pass, int32_t count);
    /* Whether a pass runs in this frame; the manifest's `when` must hold as well. [prepare] */
    aftershade_status (*set_enabled)(const aftershade_output* output, const char* pass, bool enabled);
    /* Frames before the first wanted one that must be rendered for its history, 0 to 1000. [prepare] */
    aftershade_status (*set_warm_up_frames)(const aftershade_output* output, int32_t count);
    /* How far outside the picture the effect reads, 0 to 4096 px a side. [prepare] */
    aftershade_status (*set_overscan)(const aftershade_output* output, int32_t px);
};

/* One use of an effect: made once per step of a look. Valid until its `destroy` returns. */
typedef struct aftershade_instance aftershade_instance;
struct aftershade_instance {
    uint32_t struct_size;
    void* data; /* the plug-in's own */

    /* Frees the instance and this struct. [instance] */
    void (*destroy)(const aftershade_instance* instance);

    /* Computes one frame. Frames come in any order. Returns AFTERSHADE_OK, or a status after
     * aftershade_host.set_error. [instance] */
    aftershade_status (*prepare)(const aftershade_instance* instance, const aftershade_frame* frame,
                                 const aftershade_output* output);

    /* The plug-in's struct for an extension that the host requests, or NULL; may itself be NULL. [instance]
     */
    const void* (*get_extension)(const aftershade_instance* instance, const char* id);

    /* since 1.1; may be NULL. History is dropped (a cut, a missing frame): forget it. [instance] */
    void (*reset)(const aftershade_instance* instance);
};

/* A native effect: what it is, and how to make an instance. Valid as long as the library is loaded. */
typedef struct aftershade_factory aftershade_factory;
struct aftershade_factory {
    uint32_t struct_size;
    const char* effect_id;      /* of the effect.json that it belongs to */
    const char* effect_version; /* the same as in that effect.json: declaration and code belong together */

    /* `step` names the use, for messages; copy it. NULL: failed, after host->set_error. [library] */
    const aftershade_instance* (*create)(const aftershade_factory* factory, const aftershade_host* host,
                                         const char* step);
};

/* What a library exports as `aftershade_library_entry`.
 *
 * Rationale: data, not a function, so that the host reads sizes and versions before any code of the library
 * that depends on them runs. */
typedef struct aftershade_library {
    uint32_t struct_size; /* these three never change, not even with a new major */
    uint32_t abi_major;
    uint32_t abi_minor;
    const char* name;
    const char* version;

    /* Called once before anything else, and once at the end; both may be NULL. `host` is valid until deinit
     * returns. When init returns false the library is refused with the text of set_error. [library] */
    bool (*init)(const aftershade_host* host);
    void (*deinit)(void);

    uint32_t factory_count;
    /* index is below factory_count. [library] */
    const aftershade_factory* (*get_factory)(uint32_t index);

    /* The library's struct for an extension that the host requests, or NULL; may itself be NULL. [library] */
    const void* (*get_extension)(const char* id);

    /* since 1.1; may be NULL. Where to report faults: the host adds it to the messages of failures. */
    const char* contact;
} aftershade_library;

/* Rationale: a plug-in that is linked into the host cannot share one symbol with the others; the build then
 * gives each its own name, and the source stays as it is. */
#ifndef AFTERSHADE_LIBRARY_ENTRY
#define AFTERSHADE_LIBRARY_ENTRY aftershade_library_entry
#endif
AFTERSHADE_DECLARE AFTERSHADE_EXPORT const aftershade_library AFTERSHADE_LIBRARY_ENTRY;

#endif
