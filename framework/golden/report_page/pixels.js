// Pixels out of the page's own elements, as framework/golden/report_pictures.h writes them.

async function inflate(text) {
  const stream = new Blob([bytesOf(text)]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Bits of each value, channel after channel. */
function bitsOf(planes, values, pixels, bytes) {
  const bits = new Uint32Array(values);
  for (let at = 0, first = 0; first < values; first += pixels)
    for (let shift = 0; shift < 8 * bytes; shift += 8)
      for (let i = 0, byte = 0; i < pixels; ++i, ++at) {
        byte = (byte + planes[at]) & 255;
        bits[first + i] |= byte << shift;
      }
  return bits;
}

const floatOfBits = (bits) => new Float32Array(bits.buffer);

/** IEEE 754 binary16 as binary32, for every one there is. */
const halves = (() => {
  let table = null;
  return () => {
    if (table) return table;
    table = new Float32Array(65536);
    for (let bits = 0; bits < 65536; ++bits) {
      const sign = bits & 0x8000 ? -1 : 1,
        exponent = (bits >> 10) & 31,
        fraction = bits & 1023;
      if (exponent === 0) table[bits] = sign * fraction * 2 ** -24;
      else if (exponent === 31) table[bits] = fraction ? NaN : sign * Infinity;
      else table[bits] = sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
    }
    return table;
  };
})();

/**
 * An image of the report: {x, y, width, height, channels, type, planes}, where planes[c][row * width + column] is the
 * value of a channel, and (x, y) the place of its first pixel in the file.
 */
async function readPixels(stored) {
  const pixels = stored.width * stored.height,
    values = pixels * stored.channels.length;
  const bytes = stored.type === "half" ? 2 : 4;
  const bits = bitsOf(await inflate(textOf(stored.data)), values, pixels, bytes);
  let all = bits;
  if (stored.type === "float") all = floatOfBits(bits);
  if (stored.type === "half") {
    const table = halves();
    all = new Float32Array(values);
    for (let i = 0; i < values; ++i) all[i] = table[bits[i]];
  }
  const planes = stored.channels.map((_, c) => all.subarray(c * pixels, (c + 1) * pixels));
  return { ...stored, planes };
}

/** Values of all channels of a place in the file; null outside. */
function valuesAt(image, x, y) {
  const column = x - image.x,
    row = y - image.y;
  if (column < 0 || row < 0 || column >= image.width || row >= image.height) return null;
  return image.planes.map((plane) => plane[row * image.width + column]);
}
