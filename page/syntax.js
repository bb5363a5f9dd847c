// Parts of a text that have a colour of their own: of a look, which is JSON with // comments, or of GLSL.

const KINDS = ["comment", "string", "number", "word", "name"];

const JSON_PARTS =
  /(?<comment>\/\/.*)|(?<name>"(?:[^"\\]|\\.)*"(?=\s*:))|(?<string>"(?:[^"\\]|\\.)*"?)|(?<number>-?\d[\w.+-]*)|(?<word>\b(?:true|false|null)\b)/dg;

const GLSL_WORDS =
  "break|case|const|continue|default|discard|do|else|flat|for|if|in|inout|layout|out|precise|return|shared|struct|switch|uniform|while|true|false|" +
  "void|bool|u?int|float|double|[biud]?vec[234]|d?mat[234](?:x[234])?|[iu]?(?:sampler|image)(?:1D|2D|3D|Cube|Buffer|2DArray)|atomic_uint";
const GLSL_PARTS = new RegExp(
  String.raw`(?<comment>\/\/.*|\/\*.*?(?:\*\/|$))|(?<string>^\s*#.*)|(?<number>\b\d[\w.]*|\.\d[\w.]*)|(?<word>\b(?:${GLSL_WORDS})\b)|(?<name>\b[a-zA-Z_]\w*(?=\s*\()|\bgl_\w+|\b(?:param|frame|camera)\.\w+)`,
  "dg",
);

const LANGUAGES = { json: JSON_PARTS, glsl: GLSL_PARTS };

/** [[{kind, begin, end}]]: of each line. A comment of several lines is one in each of them. */
export function partsOf(lines, language) {
  let isInside = false;
  return lines.map((line) => {
    const parts = [];
    let from = 0;
    if (isInside) {
      const end = line.indexOf("*/");
      isInside = end < 0;
      from = isInside ? line.length : end + 2;
      parts.push({ kind: "comment", begin: 0, end: from });
    }
    for (const found of line.slice(from).matchAll(LANGUAGES[language])) {
      const kind = KINDS.find((one) => found.groups[one] !== undefined),
        [begin, end] = found.indices.groups[kind];
      parts.push({ kind, begin: from + begin, end: from + end });
      if (kind === "comment" && language === "glsl" && found[0].startsWith("/*")) isInside = !found[0].endsWith("*/");
    }
    return parts;
  });
}

/** Paints parts of nodes of text by the browser's own highlights, where it has them: no markup is made. */
export class Painter {
  #ranges = [];

  static highlights = new Map(
    globalThis.Highlight
      ? KINDS.map((kind) => {
          const highlight = new Highlight();
          CSS.highlights.set(`code-${kind}`, highlight);
          return [kind, highlight];
        })
      : [],
  );

  /** `nodes`: one text for each list of parts. */
  paint(nodes, parts) {
    for (const [highlight, range] of this.#ranges) highlight.delete(range);
    this.#ranges = [];
    parts.forEach((list, i) => {
      for (const { kind, begin, end } of list) {
        const highlight = Painter.highlights.get(kind);
        if (!highlight || begin === end) continue;
        const range = new StaticRange({
          startContainer: nodes[i],
          startOffset: begin,
          endContainer: nodes[i],
          endOffset: end,
        });
        highlight.add(range);
        this.#ranges.push([highlight, range]);
      }
    });
  }
}
