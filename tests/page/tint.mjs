// An effect of a user's own, and its shader by what it makes of `light`.

export const TINT = {
  aftershade: 1,
  id: "tint",
  version: "1.0.0",
  summary: "Multiplies the colour.",
  inputs: { color: { role: "color", doc: "Any." } },
  outputs: { color: { role: "color", doc: "The same, tinted." } },
  params: { amount: { type: "float", default: 1, min: 0, max: 4, ui: [0, 2], doc: "Factor." } },
  passes: [{ name: "tint", shader: "tint.frag", reads: ["color"], writes: ["color"] }],
};

export const tintShader = (expression) => `#version 450 core
#include <pass>

void main() {
    vec4 light = texelFetch(color, ivec2(gl_FragCoord.xy), 0);
    out_color = ${expression};
}
`;
