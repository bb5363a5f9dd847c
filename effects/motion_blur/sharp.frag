#version 450 core
#include <pass>

void main() { out_color = textureLod(color, gl_FragCoord.xy * color_size.zw, 0.0); }
