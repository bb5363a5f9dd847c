// Finds an effect by its group, name and summary, and adds it as a step. Each has a picture of this frame.
import { element } from "./elements.js";
import { SearchDialog } from "./search_dialog.js";

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

export class AddDialog extends SearchDialog {
  constructor(store, thumbnails) {
    super({
      id: "found",
      className: "add-dialog",
      title: "Add a step",
      symbol: "plus",
      placeholder: "Search effects",
      label: "Search effects by name and summary",
      listLabel: "Effects",
      none: "No effect matches.",
    });
    this.store = store;
    this.thumbnails = thumbnails;
    this.node.addEventListener("close", () => thumbnails.stop());
  }

  /** `place`: in the list, before the view transform if there is one at the end. */
  open(place) {
    this.place = place;
    this.openEmpty();
  }

  /** Without words the effects stand in groups, the recommended ones first; with words, the best answers first. */
  fill(words) {
    const all = [...this.store.effects.values()],
      byName = (a, b) => a.id.localeCompare(b.id),
      isFirst = (effect) => Number(effect.recommended ?? false);
    this.thumbnails.stop();
    if (words.length) {
      const found = all
        .filter((effect) => rank(effect, words) >= 0)
        .sort((a, b) => rank(b, words) - rank(a, words) || isFirst(b) - isFirst(a) || byName(a, b));
      return this.list.replaceChildren(...found.map((effect) => this.#item(effect)));
    }
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

  #item({ id, group, recommended, summary }) {
    const { width, height } = this.store.state.capture,
      canvas = element("canvas", { width: 96, height: Math.round((96 * height) / width), "aria-hidden": "true" });
    this.thumbnails.want(canvas, [{ op: "add", at: this.place, effect: id }]);
    return element(
      "div",
      {
        role: "option",
        class: "effect",
        "aria-selected": "false",
        "data-effect": id,
        "data-group": group,
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

  take(index) {
    const { effect } = this.items[index].dataset,
      { place } = this;
    this.node.close();
    const done = this.store.edit([{ op: "add", at: place, effect }]);
    this.node.dispatchEvent(new CustomEvent("added", { detail: { at: place, done } }));
  }
}
