// What may stand at the caret of a text, in a list below it.
import { element, freshId } from "./elements.js";

const MOST = 60; // entries of the list

/** How well an entry answers what is typed: 2 to 0, or -1. */
const rank = (label, typed) =>
  label.startsWith(typed) ? 2 : label.includes(`_${typed}`) ? 1 : label.includes(typed) ? 0 : -1;

export class Completion {
  #isAsked = false;
  #isWaiting = false;
  #found = [];
  #at = 0;
  #span = null;

  /**
   * `complete(text, at)` gives {begin, end, typed, entries: [{label, insert, words}]} or null; `boxAt(at)` the place of a
   * character in the frame of the list.
   */
  constructor({ area, complete, boxAt }) {
    Object.assign(this, { area, complete, boxAt });
    this.id = freshId("completion");
    this.list = element("ul", { class: "found", role: "listbox", id: this.id, "aria-label": "Completions" });
    this.words = element("p", { class: "completion-words" });
    this.node = element("div", { class: "completion", hidden: true }, this.list, this.words);
    this.node.addEventListener("pointerdown", (event) => event.preventDefault()); // the focus stays in the text
    area.setAttribute("aria-autocomplete", "list");
    area.addEventListener("input", ({ inputType, data }) => {
      const isTyped = inputType === "insertText" && /^["\w.]$/.test(data ?? "");
      if (isTyped || (this.isOpen && inputType === "deleteContentBackward")) this.open();
      else this.close();
    });
    area.addEventListener("keydown", (event) => this.#onKey(event));
    for (const name of ["blur", "pointerdown", "scroll"]) area.addEventListener(name, () => this.close());
  }

  get isOpen() {
    return !this.node.hidden;
  }

  /** Where nothing is left to complete, there is no list. */
  open(isAsked = false) {
    const { selectionStart, selectionEnd, value, readOnly } = this.area,
      found = readOnly || selectionStart !== selectionEnd ? null : this.complete(value, selectionStart),
      typed = found?.typed.toLowerCase() ?? "",
      fitting = (found?.entries ?? [])
        .map((entry) => ({ ...entry, rank: rank(entry.label.toLowerCase(), typed) }))
        .filter((entry) => entry.rank >= 0 && (typed || isAsked || found.isOpen))
        .sort((a, b) => b.rank - a.rank)
        .slice(0, MOST);
    this.#isAsked = isAsked;
    if (!fitting.length || (fitting.length === 1 && fitting[0].label === found.typed)) {
      this.close();
      this.#isWaiting = true;
      return;
    }
    this.#found = fitting;
    this.#span = found;
    this.list.replaceChildren(
      ...fitting.map(({ label }, i) =>
        element("li", { role: "option", id: `${this.id}-${i}`, onclick: () => this.#take(i) }, label),
      ),
    );
    this.node.hidden = false;
    this.area.setAttribute("aria-controls", this.id);
    this.#select(0);
    this.#place();
  }

  /** After what fits has become known: a list that was wanted before opens, or has it too. */
  refresh() {
    if (this.isOpen || this.#isWaiting) this.open(this.#isAsked);
  }

  close() {
    this.#isWaiting = false;
    if (!this.isOpen) return;
    this.node.hidden = true;
    this.list.replaceChildren();
    this.area.removeAttribute("aria-controls");
    this.area.removeAttribute("aria-activedescendant");
  }

  /** Below the line; above it where the frame ends sooner. */
  #place() {
    const { left, top, bottom } = this.boxAt(this.#span.begin),
      frame = this.node.parentElement,
      isAbove = bottom + this.node.offsetHeight > frame.clientHeight && top > this.node.offsetHeight;
    this.node.style.left = `${Math.max(0, Math.min(left, frame.clientWidth - this.node.offsetWidth - 4))}px`;
    this.node.style.top = `${isAbove ? top - this.node.offsetHeight : bottom}px`;
  }

  #select(index) {
    const { children } = this.list;
    this.#at = (index + children.length) % children.length;
    [...children].forEach((node, i) => node.setAttribute("aria-selected", String(i === this.#at)));
    children[this.#at].scrollIntoView({ block: "nearest" });
    this.area.setAttribute("aria-activedescendant", children[this.#at].id);
    this.words.textContent = this.#found[this.#at].words ?? "";
    this.words.hidden = !this.words.textContent;
  }

  #onKey(event) {
    if (event.key === " " && event.ctrlKey) {
      event.preventDefault();
      return this.open(true);
    }
    if (!this.isOpen || event.ctrlKey || event.altKey || event.metaKey) return;
    const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (by) this.#select(this.#at + by);
    else if (event.key === "Enter" || (event.key === "Tab" && !event.shiftKey)) this.#take(this.#at);
    else if (event.key === "Escape") this.close();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  #take(index) {
    const { insert } = this.#found[index],
      { begin, end } = this.#span;
    this.close();
    this.area.focus();
    this.area.setSelectionRange(begin, end);
    // The one way that leaves the undo of the textarea whole.
    if (!document.execCommand("insertText", false, insert)) this.area.setRangeText(insert, begin, end, "end");
    this.close();
  }
}
