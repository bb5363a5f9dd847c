// Sums that people type into fields of numbers: "6+0.4", "(2 + 1) * 3 mm".

const TOKEN = /\s*(?:((?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)|([-+*/()]))/y;

/** {number, unit} of a sum with one unit at its end; null of any other text. */
export function sum(text) {
  const found = /^(.*?)\s*([a-z%]*)\s*$/.exec(text),
    tokens = [];
  TOKEN.lastIndex = 0;
  while (TOKEN.lastIndex < found[1].length) {
    const token = TOKEN.exec(found[1]);
    if (!token) return null;
    tokens.push(token[1] === undefined ? token[2] : Number(token[1]));
  }
  let at = 0;
  const factor = () => {
    const token = tokens[at++];
    if (typeof token === "number") return token;
    if (token === "-") return -factor();
    if (token === "+") return factor();
    if (token !== "(") return NaN;
    const inside = whole();
    return tokens[at++] === ")" ? inside : NaN;
  };
  const product = () => {
    let number = factor();
    while (tokens[at] === "*" || tokens[at] === "/")
      if (tokens[at++] === "*") number *= factor();
      else number /= factor();
    return number;
  };
  const whole = () => {
    let number = product();
    while (tokens[at] === "+" || tokens[at] === "-")
      if (tokens[at++] === "+") number += product();
      else number -= product();
    return number;
  };
  const number = Number(whole().toPrecision(12)); // without what doubles add to 0.1 + 0.2
  return at === tokens.length && Number.isFinite(number) ? { number, unit: found[2] } : null;
}
