/*{
  "DESCRIPTION": "What was drawn before fades away.",
  "INPUTS": [
    {
      "NAME": "inputImage",
      "TYPE": "image"
    },
    {
      "NAME": "decay",
      "TYPE": "float",
      "DEFAULT": 0.9,
      "MIN": 0,
      "MAX": 1
    }
  ],
  "PASSES": [
    {
      "TARGET": "trail",
      "PERSISTENT": true,
      "FLOAT": true
    },
    {}
  ]
}*/

void main() {
    if (PASSINDEX == 0) gl_FragColor = mix(IMG_THIS_PIXEL(inputImage), IMG_THIS_PIXEL(trail), FRAMEINDEX == 0 ? 0.0 : decay);
    else gl_FragColor = IMG_THIS_PIXEL(trail);
}
