#version 450 core
#include <pass>
#include <false_color.glsl>
#include "data.glsl"
#include "faults.glsl"

layout(location = 0) flat out vec4 tail_and_way;
layout(location = 1) flat out vec4 paint;  // colour, and the shaft's width, px

// Arrows stand on a lattice of the display window, so that a crop has the same ones: as many in a row as its tiles.
ivec2 place_of(int index) {
    int columns = (frame.size.x + param.spacing - 1) / param.spacing;
    // GLSL leaves the remainder of a negative number open.
    ivec2 above_zero = param.spacing * (max(frame.origin, 0) / param.spacing + 1);
    ivec2 offset = (param.spacing / 2 - frame.origin + above_zero) % param.spacing;
    return offset + ivec2(index % columns, index / columns) * param.spacing;
}

void main() {
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0);
    tail_and_way = paint = vec4(0.0);
    ivec2 p = place_of(gl_InstanceID);
    if (any(greaterThanEqual(p, frame.size))) return;
    vec4 data = data_at(p);
    int faults = faults_of(data);
    float most = length(vec2(frame.display_size)), size = amount_of(data), shown = min(size * param.scale, most);
    vec2 way = faults == 0 && size > 0.0 ? data.xy / size * shown : vec2(0.0);
    float width = clamp(float(param.spacing) / 14.0, 1.2, 8.0);
    bool moves = dot(way, way) > 0.0;
    vec3 hue = faults != 0 ? fault_color(faults) : moves ? wheel_color(normalize(way)) : vec3(0.6);
    vec2 tail = vec2(p) + 0.5, tip = tail + way;
    tail_and_way = vec4(tail, way);
    paint = vec4(hue, faults != 0 ? 4.0 * width : width);
    // The corners of a box along the arrow, wide enough for its head or dot.
    vec2 along = moves ? normalize(way) : vec2(1.0, 0.0), beside = vec2(-along.y, along.x);
    float margin = 2.0 * paint.w + 1.0;
    vec2 corner = (gl_VertexID & 1) == 0 ? tail - margin * along : tip + margin * along;
    corner += ((gl_VertexID >> 1) == 0 ? -margin : margin) * beside;
    gl_Position = vec4(2.0 * corner.x / float(frame.size.x) - 1.0, 1.0 - 2.0 * corner.y / float(frame.size.y), 0.0, 1.0);
}
