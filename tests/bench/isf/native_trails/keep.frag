#version 450 core
#include <pass>

void main() {
    out_trail = mix(display, trail_prev, frame.history_valid && frame.number != 0 ? param.decay : 0.0);
}
