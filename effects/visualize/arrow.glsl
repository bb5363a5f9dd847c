// How much of a pixel an arrow covers, from its edge's distance. Too short for a head, it is a dot.

struct Arrow {
    vec2 tail, way;   // where it begins, and from there to its tip, px
    float width;      // of the shaft, px
};

float arrow_head_width(Arrow arrow) { return 3.5 * arrow.width; }

float arrow_cover(Arrow arrow, vec2 p) {
    float length_ = length(arrow.way), head = min(1.2 * arrow_head_width(arrow), 0.6 * length_);
    vec2 along = length_ > 0.0 ? arrow.way / length_ : vec2(1.0, 0.0), offset = p - arrow.tail;
    // Along the arrow, and beside it.
    vec2 q = vec2(dot(offset, along), abs(dot(offset, vec2(-along.y, along.x))));
    float shaft = length(vec2(q.x - clamp(q.x, 0.0, max(length_ - head, 0.0)), q.y)) - 0.5 * arrow.width;
    // A head is 1.2 times as long as wide.
    vec2 slope = normalize(vec2(0.5 / 1.2, 1.0));
    float wedge = max(dot(vec2(q.x - length_, q.y), slope), length_ - head - q.x);
    return clamp(0.5 - (head > 0.5 ? min(shaft, wedge) : shaft), 0.0, 1.0);
}
