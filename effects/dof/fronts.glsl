// What lies in front of a pixel: gathered at full size where its blur is narrow, else upsampled.
#include "blur.glsl"
#define LOWER_FRONT front
#define LOWER_BACK back
#define LOWER_HIDES hides
#include "upsample.glsl"

struct Front {
    Coarse coarse;
    bool is_lost;       // at half size
    bool takes_coarse;
    float reach_px;     // how far it may come from
    float asked_px;     // how far it is gathered from at full size
    int which;
};

Front front_at(ivec2 p, Light own, float visible_coc, vec4 around_coc) {
    Front front;
    front.reach_px = front_reach_px(around_coc, own.coc, visible_coc);
    bool is_far = front.reach_px > kFullSizePx;
    front.coarse = upsampled(p, own.coc, visible_coc, kHalfAlikePx, kFullSizePx, (frame.size + 1) / 2 - 1);
    front.is_lost = front.coarse.likeness < kLeastLikeness;
    bool is_all = front.reach_px >= kLeastBlurPx && (!is_far || front.is_lost || front.coarse.reached < kLeastReached),
         is_narrow = is_far && !is_all && texelFetch(beyond, p / kBlock, 0).g < own.coc;
    front.takes_coarse = is_far && !is_all;
    front.asked_px = is_all ? front.reach_px : is_narrow ? kFullSizePx : kNotAsked;
    front.which = is_narrow ? kNarrow : kAll;
    return front;
}

Layer whole(Front front, Layer gathered) {
    if (front.takes_coarse) return both(gathered, front.coarse.over);
    return gathered;
}
