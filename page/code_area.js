// A text with the numbers of its lines, colours and completion. The text itself is a textarea: undo, input methods and
// screen readers are the browser's. Under it lie the same lines, which carry the colours.
import { Completion } from "./completion.js";
import { element } from "./elements.js";
import { Painter, partsOf } from "./syntax.js";

const MOST_PAINTED = 4000; // lines; colours of more would slow the typing

export class CodeArea {
  #painter = new Painter();
  #lines = [];
  #faulty = new Set();

  /** `language`: "json" or "glsl"; `complete(text, at)` gives what fits there, as Completion has it. */
  constructor({ label, describedBy, language, complete }) {
    this.language = language;
    this.back = element("div", { class: "back", "aria-hidden": "true" });
    this.area = element("textarea", {
      class: "text",
      spellcheck: "false",
      autocomplete: "off",
      autocapitalize: "off",
      "aria-label": label,
      "aria-describedby": describedBy,
    });
    this.area.addEventListener("scroll", () => (this.back.scrollTop = this.area.scrollTop));
    this.area.addEventListener("input", () => this.#draw());
    this.completion = new Completion({ area: this.area, complete, boxAt: (at) => this.#boxAt(at) });
    this.node = element("div", { class: "editor" }, this.back, this.area, this.completion.node);
  }

  get value() {
    return this.area.value;
  }
  set value(text) {
    if (text !== this.area.value) {
      const { selectionStart, scrollTop } = this.area;
      this.area.value = text;
      this.area.setSelectionRange(selectionStart, selectionStart);
      this.area.scrollTop = scrollTop;
    }
    this.#draw();
  }

  /** `faulty`: lines, from 1. */
  number(faulty) {
    this.#faulty = new Set(faulty);
    this.#draw();
  }

  /** Makes the lines under the text those of the text; lines that stay keep their nodes. */
  #draw() {
    const lines = this.area.value.split("\n"),
      old = this.#lines,
      nodes = this.back.children;
    let same = 0;
    while (same < Math.min(lines.length, old.length) && lines[same] === old[same]) ++same;
    let tail = 0;
    while (tail < Math.min(lines.length, old.length) - same && lines.at(-1 - tail) === old.at(-1 - tail)) ++tail;
    const isChanged = lines.length !== old.length || same < lines.length;
    if (isChanged) {
      const after = nodes[old.length - tail] ?? null;
      for (let i = old.length - tail - same; i > 0; --i) nodes[same].remove();
      const fresh = lines
        .slice(same, lines.length - tail)
        .map((line) =>
          element(
            "div",
            { class: "line-of-code" },
            element("span", { class: "number" }),
            document.createTextNode(line),
          ),
        );
      for (const node of fresh) this.back.insertBefore(node, after);
      this.#lines = lines;
    }
    for (let i = 0; i < nodes.length; ++i) {
      const number = nodes[i].firstChild;
      if (number.textContent !== String(i + 1)) number.textContent = i + 1;
      nodes[i].classList.toggle("faulty", this.#faulty.has(i + 1));
    }
    if (!isChanged) return;
    const painted = lines.slice(0, MOST_PAINTED);
    this.#painter.paint(
      painted.map((_, i) => nodes[i].lastChild),
      partsOf(painted, this.language),
    );
    this.back.scrollTop = this.area.scrollTop;
  }

  /** Place of a character on the screen: that of its twin under the text. */
  #boxAt(at) {
    const before = this.area.value.slice(0, at).split("\n"),
      range = document.createRange(),
      text = this.back.children[before.length - 1].lastChild;
    range.setStart(text, before.at(-1).length);
    const box = range.getBoundingClientRect(),
      line = text.parentElement.getBoundingClientRect(),
      frame = this.node.getBoundingClientRect();
    const found = box.height ? box : { left: line.left, top: line.top, bottom: line.top + 18 };
    return { left: found.left - frame.left, top: found.top - frame.top, bottom: found.bottom - frame.top };
  }

  goTo(line, column = 1) {
    const lines = this.area.value.split("\n"),
      at = lines.slice(0, line - 1).reduce((sum, one) => sum + one.length + 1, 0);
    this.area.focus();
    this.area.setSelectionRange(at + column - 1, at + (lines[line - 1]?.length ?? 0));
    const wanted = this.back.children[Math.min(Math.max(line, 4), lines.length) - 4];
    this.area.scrollTop = wanted?.offsetTop ?? 0; // three lines before it stay in sight
  }
}
