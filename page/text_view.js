// The look as text, and its faults at their lines.
import { get } from "./api.js";
import { CodeArea } from "./code_area.js";
import { button, element, notify } from "./elements.js";
import { lookWords } from "./look_words.js";

const PAUSE_MS = 500; // after the last key, before the text is sent

export class TextView {
  #schema = null;

  /** `names`: of the frame's objects. */
  constructor(store, names) {
    this.store = store;
    this.names = names;
    this.code = new CodeArea({
      label: "The look as JSON",
      describedBy: "text-help",
      language: "json",
      complete: (text, at) =>
        lookWords(
          text,
          at,
          this.#schema?.schema,
          names.list.flatMap(({ name }) => name ?? []),
        ),
    });
    this.area = this.code.area;
    this.area.addEventListener("focus", () => this.#loadWords());
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
      "The text is applied half a second after the last key. Ctrl+Space lists what fits. Tab leaves the text.",
    );
    this.node = element("div", { class: "text-view" }, this.code.node, help);
    this.sent = null;
  }

  /** The schema of the effects as they are now, and the names of this frame. */
  async #loadWords() {
    const { effects_revision } = this.store.state;
    this.names.load();
    if (this.#schema?.revision === effects_revision) return;
    try {
      this.#schema = { revision: effects_revision, schema: await get("/api/schema") };
      this.code.completion.refresh();
    } catch (error) {
      notify(error.message, true);
    }
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

  /** Whether it holds what the program has not taken. */
  get isTyped() {
    return this.shown !== undefined && this.area.value !== this.shown && this.area.value !== this.store.state.text;
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
    const { faults: all, steps, file_fault } = this.store.state,
      // That a look without steps does nothing, the list of steps says.
      faults = this.store.hasFaults || steps.length || file_fault ? all : [];
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
