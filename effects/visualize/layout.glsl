// The legend's parts. Lengths count in units of the display window, so that the legend follows the picture: 1 px of a picture
// 480 px wide.
#include "mode.glsl"

const float kMargin = 4.0;       // from the corner of the picture
const int kTitleHeight = 13;     // from the top of the panel to its drawing
const int kBarLeft = 8, kBarRight = 120, kBarBottom = kTitleHeight + 9;
const int kWheelRadius = 20;

#if SHOW == SHOW_OBJECT_ID
const int kCells = 8;            // ids from 0
#elif SHOW == SHOW_NORMAL
const int kCells = 6;            // +x -x +y -y +z -z
#else
const int kCells = 0;
#endif

#if SHOW == SHOW_VELOCITY || SHOW == SHOW_TILES
const ivec2 kBody = ivec2(64, kTitleHeight + 2 * kWheelRadius + 13);
#elif SHOW == SHOW_ARROWS
const ivec2 kBody = ivec2(80, kTitleHeight + 23);
#elif SHOW == SHOW_LIGHT
const ivec2 kBody = ivec2(80, kTitleHeight + 11);
#else
const ivec2 kBody = ivec2(128, kBarBottom + 16);
#endif

#if SHOW == SHOW_OBJECT_ID || SHOW == SHOW_NORMAL
const int kLabels = kCells;
#elif SHOW == SHOW_DEPTH || SHOW == SHOW_SIGNED || SHOW == SHOW_SCALAR
const int kLabels = 3;
#else
const int kLabels = 1;
#endif

int unit_px() {
    float width = min(float(frame.display_size.x), float(frame.display_size.y) * 16.0 / 9.0);
    return max(1, int(width / 480.0 + 0.5));
}

ivec2 panel_size(int faults) { return kBody + ivec2(0, faults != 0 ? 11 : 0); }

// Upper left corner, texels.
ivec2 panel_corner(int faults) {
    ivec2 size = panel_size(faults) * unit_px(), margin = ivec2(kMargin) * unit_px();
    bool right = param.corner == CORNER_BOTTOM_RIGHT || param.corner == CORNER_TOP_RIGHT;
    bool bottom = param.corner == CORNER_BOTTOM_LEFT || param.corner == CORNER_BOTTOM_RIGHT;
    ivec2 far = frame.display_size - size - margin;
    return ivec2(right ? far.x : margin.x, bottom ? far.y : margin.y) - frame.origin;
}

// The arrow of the key: the longest of 1, 2 and 5 times a power of ten px a frame that fits.
float key_velocity(int unit) {
    float room = 64.0 * float(unit) / max(param.scale, 1e-6), power = 1e-4;
    while (power * 10.0 <= room && power < 1e9) power *= 10.0;
    return power * (room >= 5.0 * power ? 5.0 : room >= 2.0 * power ? 2.0 : 1.0);
}
