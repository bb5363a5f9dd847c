// What the caches share: the ids that samples ask for, and what is counted.
layout(std430, binding = 0) readonly buffer Ids { uint ids[]; };
layout(std430, binding = 2) buffer Counts {
    uint requests;
    uint misses;
    uint overflows;
};
layout(std140, binding = 0) uniform Settings {
    uint width_px;
    uint pixel_count;   // of the band
    uint sample_count;
    uint tile_px;       // 0: one table for the picture
    uint slots;         // of a table, or buckets; a power of two
    uint shading_count; // of earlier bands, in buckets
    uint order_px;      // sides of squares whose pixels come one after the other; 1: rows
};
layout(std430, binding = 4) writeonly buffer Places { uint places[]; };  // of each sample's light; kNoShading: it has none in the cache

const uint kNoShading = 0xffffffffu;

// Degski's 32-bit mixer: neighbouring ids go to places far apart.
uint mixed(uint x) {
    x = (x ^ (x >> 16)) * 0x45d9f3bu;
    x = (x ^ (x >> 16)) * 0x45d9f3bu;
    return x ^ (x >> 16);
}

// Further attempts of all the samples of a pixel. llvmpipe ends every loop of an invocation after 65,535 turns in all, without an error
// (lp_bld_limits.h). The samples after that would neither be counted nor have a place.
uint attempts_left = 4096u;
