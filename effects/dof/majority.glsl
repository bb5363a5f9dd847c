// The mean of those of four texels that show the surface that most of them show: a mean over the edge of two surfaces would
// belong to neither. Where there are as many of both, texels take turns.
Light majority(Light texels[4], ivec2 texel) {
    int most = 0, first = (texel.x ^ texel.y) & 1;
    Light best = texels[0];
    for (int k = 0; k < 4; ++k) {
        int i = first == 0 ? k : 3 - k;
        vec4 sum = vec4(0.0);
        float coc_sum = 0.0;
        int friends = 0;
        for (int j = 0; j < 4; ++j)
            if (abs(texels[j].coc - texels[i].coc) <= 1.0) {
                sum += texels[j].color;
                coc_sum += texels[j].coc;
                ++friends;
            }
        if (friends > most) {
            most = friends;
            best = Light(sum / float(friends), coc_sum / float(friends));
        }
    }
    return best;
}
