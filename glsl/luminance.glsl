// Relative luminance of scene-linear Rec. 709, ITU-R BT.709-6 item 3.2.
float luminance(vec3 rgb) { return dot(rgb, vec3(0.2126, 0.7152, 0.0722)); }
