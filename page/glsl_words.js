// What may stand at a place of a shader: names of its effect, words of the file, functions of GLSL.

const FUNCTIONS =
  "abs acos asin atan ceil clamp cos cross degrees distance dot exp exp2 floor fract gl_FragCoord gl_GlobalInvocationID imageLoad imageStore inversesqrt isinf isnan length log log2 max min mix mod normalize pow radians reflect refract round sign sin smoothstep sqrt step tan texelFetch texture textureLod textureSize".split(
    " ",
  );

/** For Completion; `effect` is the manifest of the file's effect. */
export function glslWords(text, at, effect) {
  const [typed] = /[\w.]*$/.exec(text.slice(0, at)),
    end = at + /^\w*/.exec(text.slice(at))[0].length;
  if (!typed || /\/\/[^\n]*$/.test(text.slice(0, at))) return null;
  const { params = {}, inputs = {}, textures = {}, outputs = {} } = effect ?? {},
    named = (all, label) => Object.entries(all).map(([name, { doc }]) => ({ label: label(name), words: doc }));
  const entries = [
    ...named(params, (name) => `param.${name}`),
    ...named(inputs, (name) => name),
    ...named(textures, (name) => name),
    ...named(outputs, (name) => `out_${name}`),
    ...[...new Set(text.match(/\b[a-zA-Z_]\w{2,}/g))].map((label) => ({ label })),
    ...FUNCTIONS.map((label) => ({ label })),
  ];
  // The first entry of a name has its words.
  const once = [...new Map(entries.toReversed().map((entry) => [entry.label, entry])).values()].reverse();
  return {
    begin: at - typed.length,
    end,
    typed,
    entries: once.filter(({ label }) => label !== typed).map((entry) => ({ ...entry, insert: entry.label })),
  };
}
