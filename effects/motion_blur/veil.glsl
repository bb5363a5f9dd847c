// Light that a lens has spread over what a pixel shows moves as the surface that it comes from, and lies in front at all times.
#ifdef VEILED
struct Veil {
    vec4 light;
    vec2 from;
    bool comes;  // its sender's path leads to the point
};

vec4 path_of_sender(ivec2 p) { return unpack_path(texelFetch(motion, sender_of(p), 0).xy); }

bool is_light(vec4 light) { return light.a > 0.0 || amount(light.rgb) > 0.0; }

// `miss_px`: by how much the sender's way may miss the point.
Veil veil_by(vec2 point, vec4 path, float t, float miss_px) {
    vec4 guess = path_of_sender(texel_at(point - way_px(path, t)));  // as in what_comes
    vec2 from = point - way_px(guess, t);
    ivec2 texel = texel_at(from);
    vec4 light = texelFetch(veil, texel, 0);
    vec2 way = way_px(path_of_sender(texel), t);
    return Veil(light, from, is_light(light) && distance(vec2(texel) + 0.5 + way, point) < miss_px);
}

const vec2 kNowhere = vec2(-1e6);

// `light` comes from `from`. The veil comes by the path of what sends light to the point now, else by the furthest around, else it is that
// of now, if what sends it has hardly moved: else it has gone. Where both come from one place and the veil is thin, or there is none there,
// they were never apart: the pixels beside may have another surface behind the veil.
vec4 under_veil(vec4 light, vec2 from, vec2 point, vec4 sender, vec4 furthest, float t) {
    const float kMissPx = 0.75, kSenderMissPx = 1.5, kSenderMissPerPx = 0.1;  // blurred light has no sharp motion
    const float kOnePlacePx = 0.5;
    float sender_way_px = length(way_px(sender, t)), sender_miss_px = kSenderMissPx + kSenderMissPerPx * sender_way_px;
    Veil by_sender = veil_by(point, sender, t, sender_miss_px), by_furthest = veil_by(point, furthest, t, kMissPx);
    vec4 here = texelFetch(veil, texel_at(point), 0);
    Veil over = Veil(here, point, is_light(here) && sender_way_px < sender_miss_px);
    if (by_furthest.comes) over = by_furthest;
    if (by_sender.comes) over = by_sender;
    if (!over.comes) return from != kNowhere && !is_light(texelFetch(veil, texel_at(from), 0)) ? light_at(color, from) : light;
    bool is_whole = distance(over.from, from) < kOnePlacePx && amount(over.light.rgb) < amount(light.rgb);
    float alpha = alpha_of_light(over.light.a, texelFetch(color, texel_at(over.from), 0).a);
    return is_whole ? light_at(color, from) : vec4(over.light.rgb, alpha) + (1.0 - over.light.a) * light;
}
#else
const vec2 kNowhere = vec2(0.0);
vec4 path_of_sender(ivec2 p) { return vec4(0.0); }
vec4 under_veil(vec4 light, vec2 from, vec2 point, vec4 sender, vec4 furthest, float t) { return light; }
#endif
