// The look as text, with line numbers, and its faults at their lines.
import { button, element, icon } from "./elements.js";

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

/** A dialog that finds effects by name and summary, and adds one. */
export class AddDialog {
  constructor(store) {
    this.store = store;
    this.search = element("input", {
      type: "search",
      placeholder: "Search effects",
      "aria-label": "Search effects by name and summary",
      role: "combobox",
      "aria-expanded": "true",
      "aria-controls": "found",
      "aria-autocomplete": "list",
      autocomplete: "off",
      spellcheck: "false",
    });
    this.list = element("ul", { id: "found", role: "listbox", "aria-label": "Effects" });
    this.none = element("p", { class: "empty", hidden: true }, "No effect matches.");
    this.node = element(
      "dialog",
      { class: "add-dialog", "aria-label": "Add a step" },
      element("div", { class: "search" }, icon("plus"), this.search),
      this.list,
      this.none,
    );
    document.body.append(this.node);
    this.search.addEventListener("input", () => this.filter());
    this.search.addEventListener("keydown", (event) => this.onKey(event));
    this.node.addEventListener("click", (event) => event.target === this.node && this.node.close());
  }

  /** `at`: place in the list, before the view transform if there is one at the end. */
  open(at) {
    this.at = at;
    this.search.value = "";
    this.filter();
    this.node.showModal();
    this.search.focus();
  }

  filter() {
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    const rank = (effect) => {
      const id = effect.id.replaceAll("_", " "),
        text = `${effect.id} ${id} ${effect.summary}`.toLowerCase();
      if (!words.every((word) => text.includes(word))) return -1;
      return words.every((word) => id.includes(word) || effect.id.includes(word))
        ? id.startsWith(words[0] ?? "")
          ? 2
          : 1
        : 0;
    };
    const found = [...this.store.effects.values()]
      .map((effect) => ({ effect, order: rank(effect) }))
      .filter(({ order }) => order >= 0)
      .sort((a, b) => b.order - a.order || a.effect.id.localeCompare(b.effect.id));
    this.list.replaceChildren(
      ...found.map(({ effect }, i) =>
        element(
          "li",
          {
            role: "option",
            id: `found-${i}`,
            "aria-selected": "false",
            "data-effect": effect.id,
            onclick: () => this.take(effect.id),
          },
          element("span", { class: "name" }, effect.id),
          element("span", { class: "summary" }, effect.summary),
        ),
      ),
    );
    this.none.hidden = found.length > 0;
    this.choose(0);
  }

  choose(index) {
    const { children } = this.list;
    this.chosen = Math.min(Math.max(index, 0), children.length - 1);
    [...children].forEach((node, i) => node.setAttribute("aria-selected", String(i === this.chosen)));
    const node = children[this.chosen];
    if (node) this.search.setAttribute("aria-activedescendant", node.id);
    else this.search.removeAttribute("aria-activedescendant");
    node?.scrollIntoView({ block: "nearest" });
  }

  onKey(event) {
    const by = { ArrowDown: 1, ArrowUp: -1, PageDown: 8, PageUp: -8 }[event.key];
    if (by) this.choose(this.chosen + by);
    else if (event.key === "Enter") this.take(this.list.children[this.chosen]?.dataset.effect);
    else return;
    event.preventDefault();
  }

  async take(effect) {
    if (!effect) return;
    this.node.close();
    this.node.dispatchEvent(
      new CustomEvent("added", {
        detail: { at: this.at, done: this.store.edit([{ op: "add", at: this.at, effect }]) },
      }),
    );
  }
}
