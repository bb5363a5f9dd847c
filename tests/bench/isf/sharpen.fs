/*{
  "DESCRIPTION": "Adds the difference from the mean of four neighbours.",
  "INPUTS": [
    {
      "NAME": "inputImage",
      "TYPE": "image"
    },
    {
      "NAME": "amount",
      "TYPE": "float",
      "DEFAULT": 1,
      "MIN": 0,
      "MAX": 4
    }
  ]
}*/

varying vec2 left, right, above, below;

void main() {
    vec4 color = IMG_THIS_PIXEL(inputImage);
    vec4 around = IMG_NORM_PIXEL(inputImage, left) + IMG_NORM_PIXEL(inputImage, right) + IMG_NORM_PIXEL(inputImage, above) + IMG_NORM_PIXEL(inputImage, below);
    gl_FragColor = color + amount * (color - 0.25 * around);
}
