// Motion of what a layer of the capture has at a pixel. Share: the layer's alpha.
struct LayerPixel {
    float scale;    // of its motion
    float depth_m;
};

Motion layer_motion(sampler2D layer, sampler2D since, sampler2D next, LayerPixel pixel, ivec2 p) {
    Motion m = motion_of(finite(texelFetch(since, p, 0).xy), finite(texelFetch(next, p, 0).xy), pixel.scale, pixel.depth_m);
    m.share = texelFetch(layer, p, 0).a;
    return m;
}

Motion second_motion(ivec2 p) {
    LayerPixel pixel = LayerPixel(1.0, 0.0);
#ifdef HAS_SECOND_OBJECT_ID
    pixel.scale = objects(texelFetch(second_object_id, p, 0).r).scale;
#endif
#ifdef HAS_SECOND_DEPTH
    pixel.depth_m = texelFetch(second_depth, p, 0).r;
#endif
#if defined(HAS_SECOND_VELOCITY_NEXT) && CURVE
    return layer_motion(second, second_velocity, second_velocity_next, pixel, p);
#else
    return layer_motion(second, second_velocity, second_velocity, pixel, p);
#endif
}
