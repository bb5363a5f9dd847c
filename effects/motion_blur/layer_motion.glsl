// Motion of what each layer of the capture has at a pixel. Share: the layer's alpha.
Motion layer_motion(sampler2D layer, sampler2D since, sampler2D next, sampler2D distance, float scale, ivec2 p) {
    Motion m = motion_of(finite(texelFetch(since, p, 0).xy), finite(texelFetch(next, p, 0).xy), scale, texelFetch(distance, p, 0).r);
    m.share = texelFetch(layer, p, 0).a;
    return m;
}

Motion second_motion(ivec2 p) {
    float scale = 1.0;
#ifdef HAS_SECOND_OBJECT_ID
    scale = objects(texelFetch(second_object_id, p, 0).r).scale;
#endif
#if defined(HAS_SECOND_VELOCITY_NEXT) && CURVE
    return layer_motion(second, second_velocity, second_velocity_next, second_depth, scale, p);
#else
    return layer_motion(second, second_velocity, second_velocity, second_depth, scale, p);
#endif
}
