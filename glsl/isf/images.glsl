// What both shaders of an ISF file see. Its images have their origin at the bottom, ours at the top. None has levels: derivatives
// would choose among one, and cost.
vec4 isf_sample(sampler2D image, vec2 at) { return textureLod(image, vec2(at.x, 1.0 - at.y), 0.0); }
vec4 isf_sample(sampler2D image, vec2 at, float bias) { return isf_sample(image, at); }
vec4 isf_sample_level(sampler2D image, vec2 at, float level) { return isf_sample(image, at); }
vec4 isf_sample_part(sampler2D image, vec3 at) { return isf_sample(image, at.xy / at.z); }
vec4 isf_sample_part(sampler2D image, vec4 at) { return isf_sample(image, at.xy / at.w); }
vec4 isf_sample_part_level(sampler2D image, vec3 at, float level) { return isf_sample_part(image, at); }
vec4 isf_sample_part_level(sampler2D image, vec4 at, float level) { return isf_sample_part(image, at); }
vec4 isf_sample_slope(sampler2D image, vec2 at, vec2 dx, vec2 dy) { return isf_sample(image, at); }
vec4 isf_sample_part_slope(sampler2D image, vec3 at, vec2 dx, vec2 dy) { return isf_sample_part(image, at); }
vec4 isf_sample_beside(sampler2D image, vec2 at, ivec2 offset) {
    return isf_sample(image, at + vec2(offset) / vec2(textureSize(image, 0)));
}
vec4 isf_sample_level_beside(sampler2D image, vec2 at, float level, ivec2 offset) { return isf_sample_beside(image, at, offset); }
vec4 isf_sample_pixel(sampler2D image, vec2 at) { return isf_sample(image, at / vec2(textureSize(image, 0))); }
vec4 isf_fetch(sampler2D image, ivec2 at, int level) {
    return texelFetch(image, ivec2(at.x, textureSize(image, 0).y - 1 - at.y), 0);
}
vec4 isf_fetch_beside(sampler2D image, ivec2 at, int level, ivec2 offset) { return isf_fetch(image, at + offset, level); }
// In the order of textureGather(), whose rows go up.
vec4 isf_gather(sampler2D image, vec2 at, int channel) {
    vec2 down = vec2(at.x, 1.0 - at.y);
    vec4 texels = channel == 0   ? textureGather(image, down, 0)
                  : channel == 1 ? textureGather(image, down, 1)
                  : channel == 2 ? textureGather(image, down, 2)
                                 : textureGather(image, down, 3);
    return texels.wzyx;
}
vec4 isf_gather(sampler2D image, vec2 at) { return isf_gather(image, at, 0); }
vec2 isf_size(sampler2D image) { return vec2(textureSize(image, 0)); }

vec2 RENDERSIZE = ISF_SIZE;
float isf_fps = frame.fps > 0.0 ? frame.fps : 24.0;
float TIMEDELTA = 1.0 / isf_fps;
float TIME = float(frame.number) / isf_fps;
// Files fill their persistent buffers in frame 0, whatever the number of a shot's first frame.
#ifdef ISF_HISTORY
int FRAMEINDEX = frame.history_valid ? frame.number : 0;
#else
int FRAMEINDEX = frame.number;
#endif
// A render must not depend on its day.
vec4 DATE = vec4(2000.0, 1.0, 1.0, mod(TIME, 86400.0));
