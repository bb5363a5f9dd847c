// Where the two tables hold what: a block of lines for each profile, up to kProfiles.
const int kProfiles = 32;

// Of the light on a ball: columns are N.L, closest around 0, where light without scattering has its corner; lines are
// c / (1 + c) of the curvature c over which the profile's widest d stands.
const int kBallColumns = 129, kBallLines = 65;
// Of the light beside the edge of a shadow: columns are the distance into the light, lines the width of the edge itself.
const int kEdgeColumns = 129, kEdgeLines = 33;

float ball_cosine(int column) {
    float at = 2.0 * float(column) / float(kBallColumns - 1) - 1.0;
    return at * abs(at);
}
float ball_column(float cosine) {
    return (0.5 + 0.5 * sign(cosine) * sqrt(abs(cosine))) * float(kBallColumns - 1);
}
float ball_line(float curvature) { return curvature / (1.0 + curvature) * float(kBallLines - 1); }
// The last line, an infinitely small ball, counts as a very small one.
float ball_curvature(int line) {
    float at = float(line) / float(kBallLines - 1);
    return at / max(1.0 - at, 1e-3);
}

// Widths of an edge are standard deviations in d; wider ones than this scatter as if the profile were none.
const float kWidestEdge = 15.0;
float edge_line(float width) { return width / (1.0 + width) * (1.0 + 1.0 / kWidestEdge) * float(kEdgeLines - 1); }
float edge_width(int line) {
    float at = float(line) / float(kEdgeLines - 1) / (1.0 + 1.0 / kWidestEdge);
    return at / (1.0 - at);
}
// Where the table ends, in d: there is next to all light.
float edge_end(float width) { return 16.0 + 4.0 * width; }
float edge_distance(int column, float width) {
    float at = float(column) / float(kEdgeColumns - 1);
    return at * at * edge_end(width);
}
float edge_column(float distance, float width) {
    return sqrt(clamp(distance / edge_end(width), 0.0, 1.0)) * float(kEdgeColumns - 1);
}
