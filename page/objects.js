// Objects and materials of the frame by their names: what pickers, masks, tables and values write.
import { get } from "./api.js";
import { element, icon, notify } from "./elements.js";

/** How a look writes an object of the program's: by its name, or by its number where it has none. */
export const keyOf = ({ name, id }) => name ?? id;

/** The object at a probed pixel, else the material; undefined for none, and for the number of objects without one. */
export function objectAt({ objects = [] }) {
  return objects.find((one) => one.name !== undefined || one.id !== 0);
}

/** The names of a frame, read when they are first wanted. */
export class ObjectNames extends EventTarget {
  list = [];
  #key = "";

  constructor(store, viewer) {
    super();
    this.store = store;
    this.viewer = viewer;
  }

  async load() {
    const { frame } = this.viewer,
      key = `${frame} ${this.store.state.capture.path}`;
    if (key === this.#key) return;
    this.#key = key;
    try {
      this.list = await get("/api/objects", { frame });
      this.dispatchEvent(new Event("change"));
    } catch (error) {
      this.#key = "";
      notify(error.message, true);
    }
  }

  /** The name of a number that a look holds; undefined where it has none, or while the names are read. */
  nameOf(id) {
    if (typeof id !== "number") return undefined;
    this.load();
    return this.list.find((one) => one.id === id)?.name;
  }
  /** "Suzanne", "2", "4-7": an entry of a list of objects. */
  words = (entry) => String(this.nameOf(entry) ?? entry);
}

const share = (part) => `${part >= 0.0995 ? Math.round(100 * part) : (100 * part).toFixed(part < 0.001 ? 2 : 1)} %`;

/** A dialog with the objects and materials of the frame, the largest first. */
export class ObjectDialog {
  constructor(names) {
    this.names = names;
    this.search = element("input", {
      type: "search",
      placeholder: "Search objects and materials",
      "aria-label": "Search objects and materials",
      role: "combobox",
      "aria-expanded": "true",
      "aria-controls": "found-objects",
      "aria-autocomplete": "list",
      autocomplete: "off",
      spellcheck: "false",
    });
    this.list = element("ul", { id: "found-objects", class: "found", role: "listbox", "aria-label": "Objects" });
    this.none = element("p", { class: "empty", hidden: true }, "The frame has no such object.");
    this.node = element(
      "dialog",
      { class: "object-dialog", "aria-label": "Choose an object" },
      element("div", { class: "search" }, icon("list"), this.search),
      this.list,
      this.none,
    );
    document.body.append(this.node);
    this.search.addEventListener("input", () => this.show());
    this.search.addEventListener("keydown", (event) => this.onKey(event));
    this.node.addEventListener("click", (event) => event.target === this.node && this.node.close());
    names.addEventListener("change", () => this.node.open && this.show());
  }

  /** `take(key)` gets what a look writes for the chosen one. */
  open(take) {
    this.take = take;
    this.search.value = "";
    this.names.load();
    this.show();
    this.node.showModal();
    this.search.focus();
  }

  show() {
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean),
      found = this.names.list.filter((one) =>
        words.every((word) => `${keyOf(one)} ${one.kind}`.toLowerCase().includes(word)),
      );
    this.list.replaceChildren(
      ...found.map((one, i) =>
        element(
          "li",
          { role: "option", id: `object-${i}`, "aria-selected": "false", onclick: () => this.#choose(one) },
          element("span", { class: "name" }, String(keyOf(one))),
          element("span", { class: "kind" }, one.kind),
          element("span", { class: "share" }, share(one.share)),
        ),
      ),
    );
    this.found = found;
    this.none.hidden = found.length > 0;
    this.#select(0);
  }

  #select(index) {
    const { children } = this.list;
    this.at = Math.min(Math.max(index, 0), children.length - 1);
    [...children].forEach((node, i) => node.setAttribute("aria-selected", String(i === this.at)));
    const node = children[this.at];
    if (node) this.search.setAttribute("aria-activedescendant", node.id);
    else this.search.removeAttribute("aria-activedescendant");
    node?.scrollIntoView({ block: "nearest" });
  }

  onKey(event) {
    const by = { ArrowDown: 1, ArrowUp: -1, PageDown: 8, PageUp: -8 }[event.key];
    if (by) this.#select(this.at + by);
    else if (event.key === "Enter") this.found[this.at] && this.#choose(this.found[this.at]);
    else return;
    event.preventDefault();
  }

  #choose(one) {
    this.node.close();
    this.take(keyOf(one));
  }
}
