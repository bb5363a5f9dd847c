// With layers of the capture, what comes from them is composited, each by its share of its pixel.
#include <composite.glsl>

bool is_same(Found a, Found b) {
    float nearer_m = min(a.depth_m, b.depth_m), farther_m = max(a.depth_m, b.depth_m);
    return a.comes && b.comes && distance(a.from, b.from) < 1.0 && farther_m <= kOneSurface * nearer_m;
}

Motion motion_behind(usampler2D image, vec2 point) { return unpack_motion(texelFetch(image, texel_at(point), 0)); }

// What comes to the point in a layer behind.
Found comes_behind(usampler2D image, vec2 point, vec4 path, float t) {
    Motion guess = motion_behind(image, point - way_px(path, t));
    vec2 from = point - way_px(guess.share > 0.0 ? guess.path : path, t);
    Motion m = motion_behind(image, from);
    vec2 middle = vec2(texel_at(from)) + 0.5;
    float miss_px = distance(middle + way_px(m.path, t), point);
    return Found(middle, m.depth_m, m.share, m.share > 0.0 && miss_px < 1.0, true);
}

vec4 color_of(Found found) {
#ifdef SHARES_PIXELS
    if (found.share < 1.0) return texelFetch(first, texel_at(found.from), 0);
#endif
    return light_at(found.from);
}

void put(inout Light light, Found found) {
    if (found.comes) put_behind(light, color_of(found), found.share);
}

// Whether the layer shows something there, which may be one of the finds already.
bool put_hidden(inout Light light, Found found, sampler2D layer, Finds finds) {
    bool is_new = found.comes && !is_same(found, finds.near) && !is_same(found, finds.far);
    if (is_new) put_behind(light, texelFetch(layer, texel_at(found.from), 0), found.share);
    return found.comes;
}

Found first_of(Finds finds) {
    if (finds.near.comes) return finds.near;
    return finds.far;
}

// Where a find is not sure there may be another thing, such as a light at rest in front of what rolls, which does not come.
Found looked_at_again(Found found, vec2 point, float t) {
    Motion m = motion_at(found.from);
    return Found(found.from, m.depth_m, m.share, leads_to(point, found.from, m.path, t), true);
}

vec4 seen_at(vec2 point, vec4 furthest, vec4 other, Motion own, float t) {
    Finds finds = finds_at(point, furthest, other, t);
    finds = in_order(looked_at_again(finds.near, point, t), looked_at_again(finds.far, point, t));
    Light light = Light(vec4(0.0), 1.0);
    put(light, finds.near);
    if (!is_same(finds.near, finds.far)) put(light, finds.far);
    vec2 beside = beside_at(point, own, t);
    vec4 path = motion_at(beside).path;
    bool is_known = put_hidden(light, comes_behind(second_motion, point, path, t), second, finds);
#ifdef HAS_THIRD_MOTION
    bool is_deeper = put_hidden(light, comes_behind(third_motion, point, path, t), third, finds);
    is_known = is_known || is_deeper;
#endif
    if (!is_known) put_behind(light, uncovered(point, beside, own, t, light_at(beside)), 1.0);
    return light.sum;
}
