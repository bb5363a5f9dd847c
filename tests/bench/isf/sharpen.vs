varying vec2 left, right, above, below;

void main() {
    isf_vertShaderInit();
    vec2 pixel = 1.0 / RENDERSIZE;
    left = isf_FragNormCoord - vec2(pixel.x, 0.0);
    right = isf_FragNormCoord + vec2(pixel.x, 0.0);
    above = isf_FragNormCoord + vec2(0.0, pixel.y);
    below = isf_FragNormCoord - vec2(0.0, pixel.y);
}
