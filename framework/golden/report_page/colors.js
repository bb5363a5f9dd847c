// Colours of pixels, as the program's own pictures have them (framework/image/false_color.cpp, compare/side_by_side.cpp).

const rgbOfHex = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));

/** The sRGB byte of linear light: the last one whose least value it reaches, so that rounding is exact. */
const srgbByte = (() => {
  const linear = (encoded) => (encoded <= 0.04045 ? encoded / 12.92 : ((encoded + 0.055) / 1.055) ** 2.4);
  const least = Float64Array.from({ length: 257 }, (_, byte) => (byte === 256 ? Infinity : linear((byte - 0.5) / 255)));
  const steps = 4096,
    guesses = new Uint8Array(steps + 1);
  for (let i = 0, byte = 0; i <= steps; ++i) {
    while (i / steps >= least[byte + 1]) ++byte;
    guesses[i] = byte;
  }
  return (light) => {
    if (!(light > 0)) return 0;
    if (light >= 1) return 255;
    let byte = guesses[Math.floor(light * steps)];
    while (light >= least[byte + 1]) ++byte;
    return byte;
  };
})();

/** A colour of turns around the wheel, red at 0. */
function hueColor(turns, saturation, value) {
  return [3, 1, 2].map((third) => {
    const phase = turns + third / 3;
    const k = Math.abs((phase - Math.floor(phase)) * 6 - 3) - 1;
    return 255 * value * (1 + saturation * (Math.min(Math.max(k, 0), 1) - 1));
  });
}

function wheelColor(x, y) {
  const length = Math.hypot(x, y);
  if (!(length > 0)) return [0, 0, 0];
  return hueColor(Math.atan2(y, x) / (2 * Math.PI), length > 1 ? 1 / length : 1, Math.sqrt(Math.min(length, 1)));
}

/** Renderers write ids as floats; hashes of names are floats that are not integers: their bits are the id. */
const idOf = (() => {
  const float = new Float32Array(1),
    bits = new Uint32Array(float.buffer);
  return (value) => {
    if (Number.isInteger(value) && value >= 0 && value < 4294967296) return value >>> 0;
    float[0] = value;
    return bits[0];
  };
})();

function idColor(id) {
  if (id === 0) return [0, 0, 0];
  const hash = Math.imul(id, 2654435769) >>> 0;
  return hueColor(hash / 4294967296, hash & 64 ? 0.55 : 0.85, hash & 128 ? 0.95 : 0.7);
}

/** Values of some pixels of all images, sorted: `of` gives a number of a pixel, or NaN to leave it out. */
function sortedValues(images, of) {
  const pixels = images.reduce((sum, image) => sum + image.width * image.height, 0);
  const step = Math.floor(pixels / 1e6) + 1,
    values = [];
  let skip = 0;
  for (const image of images)
    for (let i = 0; i < image.width * image.height; ++i) {
      if (skip-- > 0) continue;
      skip = step - 1;
      const value = of(image.planes, i);
      if (!Number.isNaN(value) && Math.abs(value) !== Infinity) values.push(value);
    }
  return Float64Array.from(values).sort();
}

const percentile = (sorted, fraction) => sorted[Math.round(fraction * (sorted.length - 1))];

/** Stops that show a picture well, in tenths: its geometric mean as middle grey, at most a twentieth burnt out. */
function fittingStops(images) {
  const lit = sortedValues(images, (planes, i) => {
    const [red, green, blue] = [0, 1, 2].map((c) => planes[Math.min(c, planes.length - 1)][i]);
    const luminance = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
    return luminance >= 1e-6 ? luminance : NaN;
  });
  if (lit.length === 0) return 0;
  const mean = Math.exp(lit.reduce((sum, value) => sum + Math.log(value), 0) / lit.length);
  return Math.round(Math.min(Math.log2(0.18 / mean), -Math.log2(percentile(lit, 0.95))) * 10) / 10;
}

const short = (value) => (Number.isFinite(value) ? String(Number(value.toPrecision(4))) : String(value));

/** As few digits as tell a value from every other one of its type. */
function exact(value) {
  if (Number.isInteger(value) || !Number.isFinite(value)) return String(value);
  for (let digits = 1; digits < 9; ++digits)
    if (Math.fround(Number(value.toPrecision(digits))) === Math.fround(value))
      return String(Number(value.toPrecision(digits)));
  return String(Number(value.toPrecision(9)));
}

const NOTHING_HIT = 1e9; // producers write 1e10 m and more where nothing was hit

const normalColoring = {
  stops: null,
  words: "-1 to 1: x red, y green, z blue",
  color: ([x, y, z], i) => {
    const byte = (plane) => 127.5 * Math.min(Math.max(plane[i] + 1, 0), 2);
    return x[i] === 0 && y[i] === 0 && z[i] === 0 ? [0, 0, 0] : [byte(x), byte(y), byte(z)];
  },
};

const idColoring = { stops: null, words: "a colour for each id", color: ([plane], i) => idColor(idOf(plane[i])) };

/** The longest but for one in two hundred is at the rim of the wheel, in two digits; less than a tenth is rounding. */
function vectorColoring(layer, images) {
  const lengths = sortedValues(images, ([x, y], i) => Math.hypot(x[i], y[i]));
  const most = percentile(lengths, 0.995) || lengths[lengths.length - 1] || 0;
  const rim = Number(Math.max(most, 0.1).toPrecision(2));
  const words = `direction as hue, full at ${rim}${layer.role === "velocity" ? " px" : ""}`;
  return { stops: null, words, color: ([x, y], i) => wheelColor(x[i] / rim, y[i] / rim) };
}

function depthColoring(images, palette, shade) {
  const depths = sortedValues(images, ([depth], i) => (depth[i] > 0 && depth[i] < NOTHING_HIT ? depth[i] : NaN));
  const near = percentile(depths, 0.005) || 1,
    far = percentile(depths, 0.98) || 1,
    span = Math.log(far / near),
    nothing = rgbOfHex(palette.nothing_hit);
  const color = ([plane], i) => {
    const depth = plane[i];
    if (depth >= NOTHING_HIT) return nothing;
    if (depth === 0) return [0, 0, 0];
    return shade(span > 0 ? 1 - Math.log(depth / near) / span : 1);
  };
  return { stops: null, words: `bright ${short(near)} m, dark ${short(far)} m`, color };
}

function signedColoring(largest, palette) {
  const colors = palette.diverging.map(rgbOfHex);
  const color = ([plane], i) => colors[Math.round(127.5 * (1 + plane[i] / largest))] ?? colors[0];
  return { stops: null, words: `blue ${short(-largest)}, white 0, red ${short(largest)}`, color };
}

function scalarColoring(layer, images, palette, shade) {
  const values = sortedValues(images, ([plane], i) => plane[i]);
  const least = values[0] ?? 0,
    most = values[values.length - 1] ?? 1;
  if (layer.role === "data" && least < 0) return signedColoring(Math.max(-least, most), palette);
  const high = layer.role === "alpha" ? Math.max(most, 1) : most,
    low = Math.min(least, 0),
    span = high - low || 1;
  const grey = (t) => Array(3).fill(255 * Math.min(Math.max(t, 0), 1));
  const tone = layer.role === "alpha" ? grey : shade;
  const color = ([plane], i) => tone((plane[i] - low) / span);
  return { stops: null, words: `dark ${short(low)}, bright ${short(high)}`, color };
}

/** Light is exposed; encoded colours are shown as they are. */
function lightColoring(layer, images) {
  const channels = images[0].planes.length,
    green = Math.min(1, channels - 1),
    blue = Math.min(2, channels - 1);
  const encoded = (value) => 255 * Math.min(Math.max(value, 0), 1);
  const byte = layer.role === "display" ? encoded : srgbByte;
  const rgb = [0, 0, 0];
  const color = (planes, i, gain) => {
    rgb[0] = byte(planes[0][i] * gain);
    rgb[1] = byte(planes[green][i] * gain);
    rgb[2] = byte(planes[blue][i] * gain);
    return rgb; // one for all pixels: millions of arrays would take seconds
  };
  if (layer.role === "display") return { stops: null, words: "as encoded", color };
  return { stops: fittingStops(images), words: "linear light", color };
}

/**
 * How a layer is shown: {stops: what exposure begins with, or null where there is none; words; color(planes, i, gain)}.
 * `images` are all that share the scale.
 */
function coloringOf(layer, images, palette) {
  const channels = images[0].planes.length,
    ramp = palette.ramp.map(rgbOfHex);
  const shade = (t) => ramp[Math.round(255 * Math.min(Math.max(t, 0), 1))];
  if (images[0].type === "uint" || (layer.role === "id" && channels === 1)) return idColoring;
  if (channels === 3 && /normal/i.test(layer.label)) return normalColoring;
  if (channels >= 2 && layer.role === "velocity") return vectorColoring(layer, images);
  if (channels === 2 && layer.role === "data") return vectorColoring(layer, images);
  if (channels === 1 && layer.role === "depth") return depthColoring(images, palette, shade);
  if (channels < 3 && !["color", "display"].includes(layer.role)) return scalarColoring(layer, images, palette, shade);
  return lightColoring(layer, images);
}

/** Gives the colour of a pixel with values that should not be, and null of a sound one. */
function faultColoringOf(layer, palette) {
  if (layer.role === "id") return () => null;
  const [nan, infinite, negative] = [palette.nan, palette.infinite, palette.negative].map(rgbOfHex);
  const anySign = layer.role === "velocity" || layer.role === "data",
    farthest = layer.role === "depth" ? Infinity : NaN;
  return (planes, i) => {
    let fault = null;
    for (let c = 0; c < planes.length; ++c) {
      const value = planes[c][i];
      if (value !== value) return nan;
      if (Math.abs(value) === Infinity && value !== farthest) fault = infinite;
      else if (value < 0 && !anySign && !fault) fault = negative;
    }
    return fault;
  };
}

function canvasOf(width, height, colorAt) {
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext("2d"),
    picture = context.createImageData(width, height);
  for (let i = 0, at = 0; i < width * height; ++i) {
    const color = colorAt(i);
    picture.data[at++] = Math.round(color[0]);
    picture.data[at++] = Math.round(color[1]);
    picture.data[at++] = Math.round(color[2]);
    picture.data[at++] = 255;
  }
  context.putImageData(picture, 0, 0);
  return canvas;
}

/** What a tolerance's areas hold: pixels that are left out are hatched, those with limits of their own tinted and edged. */
function areaPictureOf({ x, y, width, height, runs }) {
  const marks = new Int16Array(width * height);
  for (let i = 0, at = 0; i < runs.length; i += 2) {
    marks.fill(runs[i], at, at + runs[i + 1]);
    at += runs[i + 1];
  }
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [width, height];
  const context = canvas.getContext("2d"),
    picture = context.createImageData(width, height);
  const isEdge = (i) =>
    [i % width ? i - 1 : -1, (i + 1) % width ? i + 1 : -1, i - width, i + width].some((near) => marks[near] !== marks[i]);
  for (let i = 0; i < marks.length; ++i) {
    if (!marks[i]) continue;
    const dark = ((i % width) + Math.floor(i / width)) % 4 < 2;
    const color = marks[i] > 0 ? [64, 160, 255, isEdge(i) ? 230 : 64] : dark ? [0, 0, 0, 150] : [255, 255, 255, 90];
    picture.data.set(color, 4 * i);
  }
  context.putImageData(picture, 0, 0);
  return { source: canvas, x, y, width, height };
}

/** A picture of an image, at its place in the file. */
function pictureOf(layer, image, coloring, stops, palette) {
  const gain = 2 ** stops,
    { planes } = image,
    faultAt = faultColoringOf(layer, palette);
  const canvas = canvasOf(image.width, image.height, (i) => faultAt(planes, i) ?? coloring.color(planes, i, gain));
  return { source: canvas, x: image.x, y: image.y, width: image.width, height: image.height };
}

/** |reference - test| times 2^stops where both have pixels; of ids, white where they differ. */
function differencePictureOf(layer, reference, test, stops) {
  const x = Math.max(reference.x, test.x),
    y = Math.max(reference.y, test.y);
  const width = Math.min(reference.x + reference.width, test.x + test.width) - x;
  const height = Math.min(reference.y + reference.height, test.y + test.height) - y;
  const channels = Math.min(reference.planes.length, test.planes.length),
    scale = 255 * 2 ** stops;
  if (width <= 0 || height <= 0) return null;
  const ids = layer.role === "id" || reference.type === "uint",
    rgb = [0, 0, 0];
  const one = (c, i, k) => {
    const a = reference.planes[c][i],
      b = test.planes[c][k];
    if (a === b || (a !== a && b !== b)) return 0;
    const value = Math.abs(a - b) * scale;
    return ids || !(value < 255) ? 255 : value; // what cannot be subtracted is the brightest
  };
  const canvas = canvasOf(width, height, (at) => {
    const column = at % width,
      row = (at - column) / width;
    const i = (row + y - reference.y) * reference.width + column + x - reference.x;
    const k = (row + y - test.y) * test.width + column + x - test.x;
    rgb[0] = one(0, i, k);
    rgb[1] = channels > 1 ? one(1, i, k) : rgb[0];
    rgb[2] = channels > 2 ? one(2, i, k) : channels > 1 ? 0 : rgb[0]; // two channels are red and green
    return rgb;
  });
  return { source: canvas, x, y, width, height };
}
