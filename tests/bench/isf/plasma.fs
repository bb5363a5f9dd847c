/*{
  "DESCRIPTION": "Waves of colour over time.",
  "INPUTS": [
    {
      "NAME": "scale",
      "TYPE": "float",
      "DEFAULT": 6,
      "MIN": 1,
      "MAX": 30
    }
  ]
}*/

void main() {
    vec2 at = isf_FragNormCoord * scale;
    float wave = sin(at.x + TIME) + sin(at.y * 1.3 - TIME) + sin(length(at - 0.5 * scale) * 2.0);
    gl_FragColor = vec4(0.5 + 0.5 * cos(wave + vec3(0.0, 2.1, 4.2)), 1.0);
}
