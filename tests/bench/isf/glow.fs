/*{
  "DESCRIPTION": "Bright light spread by two blurs at half the size.",
  "INPUTS": [
    {
      "NAME": "inputImage",
      "TYPE": "image"
    },
    {
      "NAME": "amount",
      "TYPE": "float",
      "DEFAULT": 0.6,
      "MIN": 0,
      "MAX": 2
    }
  ],
  "PASSES": [
    {
      "TARGET": "across",
      "WIDTH": "floor($WIDTH / 2.0)",
      "HEIGHT": "floor($HEIGHT / 2.0)"
    },
    {
      "TARGET": "spread",
      "WIDTH": "floor($WIDTH / 2.0)",
      "HEIGHT": "floor($HEIGHT / 2.0)"
    },
    {}
  ]
}*/

vec4 blurred(sampler2D image, vec2 along) {
    vec4 sum = 0.3 * IMG_NORM_PIXEL(image, isf_FragNormCoord);
    for (int i = 1; i < 4; ++i)
        sum += (0.175 - 0.05 * float(i - 1)) * (IMG_NORM_PIXEL(image, isf_FragNormCoord + float(i) * along) + IMG_NORM_PIXEL(image, isf_FragNormCoord - float(i) * along));
    return sum;
}

void main() {
    if (PASSINDEX == 0) gl_FragColor = blurred(inputImage, vec2(2.0 / RENDERSIZE.x, 0.0));
    else if (PASSINDEX == 1) gl_FragColor = blurred(across, vec2(0.0, 2.0 / RENDERSIZE.y));
    else {
        vec4 color = IMG_THIS_PIXEL(inputImage);
        vec3 light = max(IMG_THIS_PIXEL(spread).rgb - 0.5, 0.0);
        gl_FragColor = vec4(color.rgb + amount * light, color.a);
    }
}
