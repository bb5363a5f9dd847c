/*{
  "DESCRIPTION": "Turns the picture around its centre.",
  "INPUTS": [
    {
      "NAME": "inputImage",
      "TYPE": "image"
    },
    {
      "NAME": "angle",
      "TYPE": "float",
      "DEFAULT": 1.5,
      "MIN": -6,
      "MAX": 6
    }
  ]
}*/

void main() {
    vec2 at = isf_FragNormCoord - 0.5;
    float turn = angle * smoothstep(0.5, 0.0, length(at));
    float c = cos(turn), s = sin(turn);
    gl_FragColor = IMG_NORM_PIXEL(inputImage, vec2(c * at.x - s * at.y, s * at.x + c * at.y) + 0.5);
}
