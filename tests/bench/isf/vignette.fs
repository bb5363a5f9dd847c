/*{
  "DESCRIPTION": "Darkens towards the edges.",
  "INPUTS": [
    {
      "NAME": "inputImage",
      "TYPE": "image"
    },
    {
      "NAME": "radius",
      "TYPE": "float",
      "DEFAULT": 0.7,
      "MIN": 0,
      "MAX": 2
    }
  ]
}*/

void main() {
    vec2 from_center = isf_FragNormCoord - 0.5;
    float light = 1.0 - smoothstep(0.3 * radius, radius, length(from_center));
    vec4 color = IMG_PIXEL(inputImage, gl_FragCoord.xy);
    gl_FragColor = vec4(color.rgb * light, color.a);
}
