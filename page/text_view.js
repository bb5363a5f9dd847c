// The look as text, with line numbers, and its faults at their lines.
import { button, element } from "./elements.js";

const PAUSE_MS = 500; // after the last key, before the text is sent

/** Lines of text with their numbers; those with faults are marked. */
export class CodeArea {
  #signature = null;

  constructor({ label, describedBy }) {
    this.numbers = element("div", { class: "numbers", "aria-hidden": "true" });
    this.area = element("textarea", {
      class: "text",
      spellcheck: "false",
      autocomplete: "off",
      wrap: "off",
      "aria-label": label,
      "aria-describedby": describedBy,
    });
    this.area.addEventListener("scroll", () => (this.numbers.scrollTop = this.area.scrollTop));
    this.node = element("div", { class: "editor" }, this.numbers, this.area);
  }

  get value() {
    return this.area.value;
  }
  set value(text) {
    if (text === this.area.value) return;
    const { selectionStart, scrollTop } = this.area;
    this.area.value = text;
    this.area.setSelectionRange(selectionStart, selectionStart);
    this.area.scrollTop = scrollTop;
  }

  /** `faulty`: lines, from 1. */
  number(faulty) {
    const count = this.area.value.split("\n").length,
      marked = new Set(faulty),
      signature = `${count} ${[...marked]}`;
    if (signature === this.#signature) return;
    this.#signature = signature;
    this.numbers.replaceChildren(
      ...Array.from({ length: count }, (_, i) =>
        element("div", { class: marked.has(i + 1) ? "faulty" : null }, String(i + 1)),
      ),
    );
    this.numbers.scrollTop = this.area.scrollTop;
  }

  goTo(line, column = 1) {
    const lines = this.area.value.split("\n"),
      at = lines.slice(0, line - 1).reduce((sum, one) => sum + one.length + 1, 0);
    this.area.focus();
    this.area.setSelectionRange(at + column - 1, at + (lines[line - 1]?.length ?? 0));
    const height = this.area.scrollHeight / lines.length;
    this.area.scrollTop = Math.max(0, (line - 4) * height);
  }
}

export class TextView {
  constructor(store) {
    this.store = store;
    this.code = new CodeArea({ label: "The look as JSON", describedBy: "text-help" });
    this.area = this.code.area;
    this.area.addEventListener("input", () => {
      this.number();
      clearTimeout(this.timer);
      this.timer = setTimeout(() => this.send(), PAUSE_MS);
    });
    this.area.addEventListener("change", () => this.send());
    this.area.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && event.ctrlKey) this.send();
    });
    const help = element(
      "p",
      { class: "hint shown", id: "text-help" },
      "The text is applied half a second after the last key. Tab leaves the text.",
    );
    this.node = element("div", { class: "text-view" }, this.code.node, help);
    this.sent = null;
  }

  async send() {
    clearTimeout(this.timer);
    const { value } = this.area;
    if (value === this.store.state.text || value === this.sent) return;
    this.sent = value;
    await this.store.edit([{ op: "text", value }]);
    this.sent = null;
  }

  get isEdited() {
    return document.activeElement === this.area && this.area.value !== this.shown;
  }

  update() {
    const { text, read_only } = this.store.state;
    this.area.readOnly = read_only;
    if (!(this.isEdited && this.area.value !== this.sent)) this.code.value = text;
    if (this.area.value === text) this.shown = text;
    this.number();
  }

  number() {
    this.code.number(this.store.state.faults.map(({ line }) => line));
  }

  goTo(line, column) {
    this.code.goTo(line, column);
  }
}

/** faults: [{place, message}]; a press gives the fault to `goTo`. */
export const faultList = (faults, goTo) =>
  element(
    "ul",
    {},
    faults.map((fault) =>
      element(
        "li",
        {},
        button([element("span", { class: "place" }, fault.place), element("span", {}, fault.message)], () =>
          goTo(fault),
        ),
      ),
    ),
  );

/** The faults of the look; a press goes to the line. */
export class Faults {
  constructor(store, goTo) {
    this.store = store;
    this.goTo = goTo;
    this.node = element("div", { class: "faults", role: "alert", hidden: true });
  }
  words(faults) {
    const errors = faults.filter(({ severity }) => severity !== "warning").length,
      warnings = faults.length - errors;
    const counted = (count, word) => (count ? [`${count} ${word}${count === 1 ? "" : "s"}`] : []);
    return (
      [...counted(errors, "fault"), ...counted(warnings, "warning")].join(", ") +
      (errors ? ": the picture is the last good one" : "")
    );
  }
  update() {
    const { faults: all, steps } = this.store.state,
      // That a look without steps does nothing, the list of steps says.
      faults = this.store.hasFaults || steps.length ? all : [];
    this.node.classList.toggle("only-warnings", !this.store.hasFaults);
    this.node.hidden = faults.length === 0;
    const signature = JSON.stringify(faults);
    if (signature === this.signature) return;
    this.signature = signature;
    this.node.replaceChildren(
      element("p", { class: "count" }, this.words(faults)),
      faultList(
        faults.map((fault) => ({ ...fault, place: fault.line ? `${fault.line}:${fault.column || 1}` : "look" })),
        ({ line, column }) => this.goTo(line || 1, column || 1),
      ),
    );
  }
}
