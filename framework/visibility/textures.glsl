// Pictures on surfaces: the twin of scene::SurfaceTexture in single precision.
// A map is the place of a texture in `looks`, which gpu_textures.h explains, times 8, plus the channel of its texture coordinates.
const uint kNoMap = 0xffffffffu;
const uint kRepeat = 0u, kMirror = 1u;    // 2: clamp
const uint kSrgb = 1u, kNormal = 2u;      // 0: linear
const float kMostTaps = 8.0;
const float kLeastWeight = 1e-4;  // of a colour of alpha 0, where colours count by alpha

struct Map {
    uint first;  // texel of the finest level
    ivec2 size;
    int levels;
    uint kinds;  // how u repeats, v by 4; what texels stand for by 16; 64: nearest; 128: colours count by alpha
};

bool counts_by_alpha(Map map) { return kHasAlpha && (map.kinds & 128u) != 0u; }

vec4 texel_value(uint word, uint values) {
    vec4 texel = unpackUnorm4x8(word);
    vec3 stored = texel.rgb;
    if (values == kSrgb) {
        bvec3 straight = lessThanEqual(stored, vec3(12.92 * 0.0031308));
        texel.rgb = mix(pow((stored + 0.055) / 1.055, vec3(2.4)), stored / 12.92, straight);
    } else if (values == kNormal) {
        uvec3 bytes = uvec3(word, word >> 8, word >> 16) & 255u;
        texel.rgb = mix(stored * 2.0 - 1.0, vec3(0.0), equal((bytes + 1u) >> 1, uvec3(64u)));  // of 127 and 128
    }
    return texel;
}

float folded(uint wrap, float u) {
    if (wrap == kRepeat) return u - floor(u);
    if (wrap != kMirror) return clamp(u, 0.0, 1.0);
    float turn = u - 2.0 * floor(0.5 * u);
    return turn > 1.0 ? 2.0 - turn : turn;
}

vec2 folded_uv(Map map, vec2 uv) {
    return vec2(folded(map.kinds & 3u, uv.x), folded((map.kinds >> 2) & 3u, uv.y));
}

int inside(uint wrap, int at, int side) {
    if (wrap != kRepeat) return clamp(at, 0, side - 1);
    return at < 0 ? side - 1 : at >= side ? 0 : at;
}

vec4 texel(Map map, uint first, ivec2 size, ivec2 at) {
    int row = inside((map.kinds >> 2) & 3u, at.y, size.y), column = inside(map.kinds & 3u, at.x, size.x);
    vec4 value = texel_value(looks[first + uint(row * size.x + column)], (map.kinds >> 4) & 3u);
    return counts_by_alpha(map) ? vec4(value.rgb * (value.a + kLeastWeight), value.a) : value;
}

vec4 blended(Map map, int level, vec2 uv) {
    ivec2 size = map.size;
    uint first = map.first;
    for (int i = 0; i < level; ++i) {
        first += uint(size.x * size.y);
        size = max(size / 2, ivec2(1));
    }
    vec2 at = folded_uv(map, uv) * vec2(size) - 0.5, part = at - floor(at);
    ivec2 low = ivec2(floor(at));
    vec4 above = mix(texel(map, first, size, low), texel(map, first, size, low + ivec2(1, 0)), part.x);
    vec4 below = mix(texel(map, first, size, low + ivec2(0, 1)), texel(map, first, size, low + ivec2(1, 1)), part.x);
    return mix(above, below, part.y);
}

// The mean over a pixel whose sides in texture coordinates are the columns of `uv_of_pixel`; w: alpha.
vec4 texture_at(uint index, vec2 uv, mat2 uv_of_pixel) {
    ivec2 size = ivec2(looks[index], looks[index + 1u]);
    Map map = Map(index + 4u, size, int(looks[index + 2u]), looks[index + 3u]);
    // Squares of more would be infinite in single precision.
    mat2 sides = mat2(clamp(uv_of_pixel[0] * vec2(size), -1e9, 1e9), clamp(uv_of_pixel[1] * vec2(size), -1e9, 1e9));
    float a = sides[0].x * sides[0].x + sides[1].x * sides[1].x, b = sides[0].x * sides[0].y + sides[1].x * sides[1].y;
    float c = sides[0].y * sides[0].y + sides[1].y * sides[1].y, middle = 0.5 * (a - c), apart = sqrt(middle * middle + b * b);
    float longer = sqrt(0.5 * (a + c) + apart), shorter = longer > 0.0 ? abs(determinant(sides)) / longer : 0.0;
    vec2 along = middle >= 0.0 ? vec2(middle + apart, b) : vec2(b, apart - middle);
    along = length(along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
    float ratio = longer / max(shorter, 1.0) - 0.01;
    int taps = ratio > 1.0 ? int(ceil(min(ratio, kMostTaps))) : 1;
    float across = max(longer / float(taps), shorter);
    float level = across > 1.0 ? min(log2(across), float(map.levels - 1)) : 0.0;
    int fine = int(level);
    float part = level - float(fine);
    vec4 sum = vec4(0.0);
    for (int tap = 0; tap < taps; ++tap) {
        vec2 place = uv + ((float(tap) + 0.5) / float(taps) - 0.5) * longer * along / vec2(size);
        if (level <= 0.0 && (map.kinds & 64u) != 0u) {
            sum += texel(map, map.first, size, ivec2(folded_uv(map, place) * vec2(size)));
            continue;
        }
        vec4 value = blended(map, fine, place);
        sum += part > 0.0 ? mix(value, blended(map, fine + 1, place), part) : value;
    }
    sum /= float(taps);
    return counts_by_alpha(map) ? vec4(sum.rgb / (sum.a + kLeastWeight), sum.a) : sum;
}

// A point of a triangle of an object: the twin of scene::TexturePoint.
struct TexturePoint {
    uint surface;  // the triangle's number among those of all objects
    vec3 weights;
    mat2 weights_of_pixel;
    vec2 uv;  // channel 0
    mat2 uv_of_pixel;
};

// The texture coordinates of a triangle's corners.
mat3x2 extra_uvs(uint surface, uint channel) {
    uint at = surface * extras_stride + extras_uvs + 2u * channel;
    return mat3x2(extras[at].xy, extras[at].zw, extras[at + 1u].xy);
}

uint extra_material(uint surface) {
    return floatBitsToUint(extras[surface * extras_stride + extras_uvs + 1u].z);
}

TexturePoint texture_point(uint surface, vec3 weights, mat2 weights_of_pixel, mat3x2 uvs) {
    mat2 uv_of_weights = mat2(uvs[1] - uvs[0], uvs[2] - uvs[0]);
    return TexturePoint(surface, weights, weights_of_pixel, uvs * weights, uv_of_weights * weights_of_pixel);
}

// 1 without a map.
vec4 map_at(uint map, TexturePoint at) {
    if (map == kNoMap) return vec4(1.0);
    if ((map & 7u) != 0u) at = texture_point(at.surface, at.weights, at.weights_of_pixel, extra_uvs(at.surface, map & 7u));
    return texture_at(map >> 3, at.uv, at.uv_of_pixel);
}

// Whether the triangle has a hole there, of a material with a cutoff.
bool is_hole(uint surface, vec3 weights) {
    Material material = material_at(extra_material(surface));
    if (material.alpha_cutoff <= 0.0) return false;
    return map_at(material.maps.x, texture_point(surface, weights, mat2(0.0), extra_uvs(surface, 0u))).w < material.alpha_cutoff;
}

// Of a triangle of a mixed object.
float mixed_opacity(uint surface, vec3 weights, mat2 weights_of_pixel) {
    Material material = material_at(extra_material(surface));
    if (!material.blends) return material.opacity;
    return material.opacity * map_at(material.maps.x, texture_point(surface, weights, weights_of_pixel, extra_uvs(surface, 0u))).w;
}
