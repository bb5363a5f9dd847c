// A pixel of a layer behind the picture, premultiplied, as light of a surface that covers it: alpha 0 where it covers half or less.
vec4 covering(vec4 behind) { return behind.a > 0.5 ? behind / behind.a : vec4(0.0); }
