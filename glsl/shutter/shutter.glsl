// When the shutter opens and closes, in frames from the frame's own time.
vec2 shutter_span() {
    float exposure = param.shutter_angle / 360.0;
#if SHUTTER_PHASE == SHUTTER_PHASE_START
    return vec2(0.0, exposure);
#elif SHUTTER_PHASE == SHUTTER_PHASE_END
    return vec2(-exposure, 0.0);
#else
    return vec2(-0.5, 0.5) * exposure;
#endif
}
