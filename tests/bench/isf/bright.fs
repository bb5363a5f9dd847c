/*{
  "DESCRIPTION": "Gain and contrast of each pixel.",
  "INPUTS": [
    {
      "NAME": "inputImage",
      "TYPE": "image"
    },
    {
      "NAME": "gain",
      "TYPE": "float",
      "DEFAULT": 1.2,
      "MIN": 0,
      "MAX": 4
    },
    {
      "NAME": "contrast",
      "TYPE": "float",
      "DEFAULT": 1.1,
      "MIN": 0,
      "MAX": 4
    }
  ]
}*/

void main() {
    vec4 color = IMG_THIS_PIXEL(inputImage);
    color.rgb = (color.rgb * gain - 0.5) * contrast + 0.5;
    gl_FragColor = color;
}
