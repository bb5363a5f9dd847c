// The mean of those of four texels that show the surface that most of them show: a mean over the edge of two surfaces would
// belong to neither. Where there are as many of both, texels take turns. By sums over all four, because software GL takes every branch
// and keeps what an index that varies chooses from in memory.
Light majority(Light texels[4], ivec2 texel) {
    vec4 cocs = vec4(texels[0].coc, texels[1].coc, texels[2].coc, texels[3].coc);
    vec4 friends_of[4];
    for (int i = 0; i < 4; ++i) friends_of[i] = vec4(lessThanEqual(abs(cocs - cocs[i]), vec4(1.0)));
    vec4 counts = friends_of[0] + friends_of[1] + friends_of[2] + friends_of[3];
    float most = max(max(counts.x, counts.y), max(counts.z, counts.w));
    bvec4 are_best = equal(counts, vec4(most));
    bool is_first = ((texel.x ^ texel.y) & 1) == 0;
    int early = are_best.x ? 0 : are_best.y ? 1 : are_best.z ? 2 : 3, late = are_best.w ? 3 : are_best.z ? 2 : are_best.y ? 1 : 0;
    int best = is_first ? early : late;
    vec4 friends = best < 2 ? (best == 0 ? friends_of[0] : friends_of[1]) : (best == 2 ? friends_of[2] : friends_of[3]);
    vec4 sum = vec4(0.0);
    float coc_sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        sum += friends[i] > 0.0 ? texels[i].color : vec4(0.0);
        coc_sum += friends[i] > 0.0 ? texels[i].coc : 0.0;
    }
    return Light(sum / most, coc_sum / most);
}
