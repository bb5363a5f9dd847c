// Where the values of a JSON text with // comments stand, so that one can be replaced and the rest kept.

/** {begin, end, value} of the text, and of an object `members`, a Map of the same. Throws on what is not JSON. */
export function readText(text) {
  let at = 0;
  const fail = () => {
    throw new SyntaxError(`not JSON at character ${at}`);
  };
  const blank = () => {
    const found = /^(?:\s+|\/\/[^\n]*)+/.exec(text.slice(at));
    if (found) at += found[0].length;
  };
  const take = (sign) => {
    blank();
    if (text[at] !== sign) return false;
    ++at;
    return true;
  };
  const scalar = () => {
    const found = /^(?:"(?:[^"\\]|\\.)*"|[-+.\w]+)/.exec(text.slice(at)) ?? fail();
    const value = JSON.parse(found[0]);
    at += found[0].length;
    return value;
  };
  function node() {
    blank();
    const begin = at;
    if (take("{")) {
      const members = new Map(),
        value = {};
      for (let isFirst = true; !take("}"); isFirst = false) {
        if (!isFirst && !take(",")) fail();
        blank();
        const key = scalar();
        if (typeof key !== "string" || !take(":")) fail();
        const member = node();
        members.set(key, member);
        Object.defineProperty(value, key, { value: member.value, enumerable: true });
      }
      return { begin, end: at, value, members };
    }
    if (take("[")) {
      const value = [];
      for (let isFirst = true; !take("]"); isFirst = false) {
        if (!isFirst && !take(",")) fail();
        value.push(node().value);
      }
      return { begin, end: at, value };
    }
    const value = scalar();
    return { begin, end: at, value };
  }
  return node();
}

/** The text with another value at a node. */
export const replaced = (text, { begin, end }, value) => text.slice(0, begin) + JSON.stringify(value) + text.slice(end);
