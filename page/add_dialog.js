// Finds an effect by its group, name and summary, and adds it as a step. Each has a picture of this frame.
import { element, icon } from "./elements.js";

/** The groups of manifests, in the order of lists. */
const GROUPS = {
  lens: "Lens",
  shutter: "Shutter",
  scattering: "Scattering",
  light: "Light",
  film: "Film",
  color: "Colour",
  repair: "Repair",
  diagnosis: "Diagnosis",
};
const ORDER = Object.keys(GROUPS);
const placeOf = ({ group }) => (ORDER.includes(group) ? ORDER.indexOf(group) : ORDER.length);

/** How well an effect answers the words: 3 to 0, or -1. */
function rank(effect, words) {
  const id = effect.id.replaceAll("_", " "),
    text = `${effect.id} ${id} ${GROUPS[effect.group] ?? ""} ${effect.summary}`.toLowerCase();
  if (!words.every((word) => text.includes(word))) return -1;
  const isName = words.every((word) => id.includes(word) || effect.id.includes(word));
  return isName ? (id.startsWith(words[0] ?? "") ? 3 : 2) : effect.recommended ? 1 : 0;
}

export class AddDialog {
  constructor(store, thumbnails) {
    this.store = store;
    this.thumbnails = thumbnails;
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
    this.list = element("div", { id: "found", role: "listbox", "aria-label": "Effects" });
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
    this.node.addEventListener("close", () => thumbnails.stop());
  }

  /** `at`: place in the list, before the view transform if there is one at the end. */
  open(at) {
    this.at = at;
    this.search.value = "";
    this.node.showModal();
    this.filter();
    this.search.focus();
  }

  get items() {
    return [...this.list.querySelectorAll("[role=option]")];
  }

  /** Without words the effects stand in groups, the recommended ones first; with words, the best answers first. */
  filter() {
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean),
      all = [...this.store.effects.values()],
      byName = (a, b) => a.id.localeCompare(b.id),
      isFirst = (effect) => Number(effect.recommended ?? false);
    this.thumbnails.stop();
    if (words.length) {
      const found = all
        .filter((effect) => rank(effect, words) >= 0)
        .sort((a, b) => rank(b, words) - rank(a, words) || isFirst(b) - isFirst(a) || byName(a, b));
      this.list.replaceChildren(...found.map((effect) => this.#item(effect)));
    } else {
      const sorted = all.sort((a, b) => placeOf(a) - placeOf(b) || isFirst(b) - isFirst(a) || byName(a, b)),
        groups = Map.groupBy(sorted, ({ group }) => GROUPS[group] ?? "Others");
      this.list.replaceChildren(
        ...[...groups].map(([title, effects]) =>
          element(
            "div",
            { role: "group", "aria-label": title },
            element("div", { class: "group-title", "aria-hidden": "true" }, title),
            effects.map((effect) => this.#item(effect)),
          ),
        ),
      );
    }
    this.items.forEach((item, i) => (item.id = `found-${i}`));
    this.none.hidden = this.items.length > 0;
    this.choose(0);
  }

  #item({ id, group, recommended, summary }) {
    const { width, height } = this.store.state.capture,
      canvas = element("canvas", { width: 96, height: Math.round((96 * height) / width), "aria-hidden": "true" });
    this.thumbnails.want(canvas, [{ op: "add", at: this.at, effect: id }]);
    return element(
      "div",
      {
        role: "option",
        class: "effect",
        "aria-selected": "false",
        "data-effect": id,
        "data-group": group,
        onclick: () => this.take(id),
      },
      canvas,
      element(
        "span",
        { class: "name" },
        id,
        recommended ? element("span", { class: "recommended" }, "recommended") : null,
      ),
      element("span", { class: "summary" }, summary),
    );
  }

  choose(index) {
    const { items } = this;
    this.chosen = Math.min(Math.max(index, 0), items.length - 1);
    items.forEach((node, i) => node.setAttribute("aria-selected", String(i === this.chosen)));
    const node = items[this.chosen];
    if (node) this.search.setAttribute("aria-activedescendant", node.id);
    else this.search.removeAttribute("aria-activedescendant");
    if (this.chosen === 0) this.list.scrollTop = 0;
    else node?.scrollIntoView({ block: "nearest" });
  }

  onKey(event) {
    const by = { ArrowDown: 1, ArrowUp: -1, PageDown: 8, PageUp: -8 }[event.key];
    if (by) this.choose(this.chosen + by);
    else if (event.key === "Enter") this.take(this.items[this.chosen]?.dataset.effect);
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
