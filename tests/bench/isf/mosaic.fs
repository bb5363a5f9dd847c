/*{
  "DESCRIPTION": "Squares of one colour.",
  "INPUTS": [
    {
      "NAME": "inputImage",
      "TYPE": "image"
    },
    {
      "NAME": "side",
      "TYPE": "float",
      "DEFAULT": 24,
      "MIN": 1,
      "MAX": 200
    }
  ]
}*/

void main() {
    vec2 middle = (floor(gl_FragCoord.xy / side) + 0.5) * side;
    gl_FragColor = IMG_NORM_PIXEL(inputImage, middle / RENDERSIZE);
}
