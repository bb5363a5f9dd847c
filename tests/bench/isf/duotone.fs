/*{
  "DESCRIPTION": "Luminance as a mix of two colours.",
  "INPUTS": [
    {
      "NAME": "inputImage",
      "TYPE": "image"
    },
    {
      "NAME": "dark",
      "TYPE": "color",
      "DEFAULT": [
        0.1,
        0.0,
        0.3,
        1.0
      ]
    },
    {
      "NAME": "light",
      "TYPE": "color",
      "DEFAULT": [
        1.0,
        0.9,
        0.6,
        1.0
      ]
    }
  ]
}*/

void main() {
    vec4 color = IMG_THIS_NORM_PIXEL(inputImage);
    float luminance = dot(color.rgb, vec3(0.2126, 0.7152, 0.0722));
    gl_FragColor = vec4(mix(dark.rgb, light.rgb, smoothstep(0.0, 1.0, luminance)), color.a);
}
