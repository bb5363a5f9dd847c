// Light that a lens has spread over what a pixel shows moves as the surface that it comes from, and lies in front at all times.
#ifdef VEILED
struct Veil {
    vec4 light;
    vec2 from;
    bool comes;  // its sender's path leads to the point
};

vec4 path_of_sender(ivec2 p) { return unpack_path(texelFetch(motion, sender_of(p), 0).xy); }

// `miss_px`: by how much the sender's way may miss the point.
Veil veil_by(vec2 point, vec4 path, float t, float miss_px) {
    vec2 from = point - way_px(path, t);
    ivec2 texel = texel_at(from);
    vec4 light = texelFetch(veil, texel, 0);
    vec2 way = way_px(path_of_sender(texel), t);
    bool is_light = light.a > 0.0 || amount(light.rgb) > 0.0;
    return Veil(light, from, is_light && distance(vec2(texel) + 0.5 + way, point) < miss_px);
}

const vec2 kNowhere = vec2(-1e6);

// `light` comes from `from`. The veil comes by the path of what sends light to the point now, else by the furthest around, else it is that
// of now. Where both come from one place and the veil is thin, they were never apart: the pixels beside may have another surface behind
// the veil.
vec4 under_veil(vec4 light, vec2 from, vec2 point, vec4 sender, vec4 furthest, float t) {
    const float kMissPx = 0.75, kSenderMissPx = 1.5, kSenderMissPerPx = 0.1;  // blurred light has no sharp motion
    const float kOnePlacePx = 0.5;
    float sender_miss_px = kSenderMissPx + kSenderMissPerPx * length(way_px(sender, t));
    Veil by_sender = veil_by(point, sender, t, sender_miss_px), by_furthest = veil_by(point, furthest, t, kMissPx);
    Veil over = Veil(texelFetch(veil, texel_at(point), 0), point, true);
    if (by_furthest.comes) over = by_furthest;
    if (by_sender.comes) over = by_sender;
    bool is_whole = distance(over.from, from) < kOnePlacePx && amount(over.light.rgb) < amount(light.rgb);
    return is_whole ? light_at(color, from) : over.light + (1.0 - over.light.a) * light;
}
#else
const vec2 kNowhere = vec2(0.0);
vec4 path_of_sender(ivec2 p) { return vec4(0.0); }
vec4 under_veil(vec4 light, vec2 from, vec2 point, vec4 sender, vec4 furthest, float t) { return light; }
#endif
