// Objects and materials of the frame by their names: what pickers, masks, tables and values write.
import { get } from "./api.js";
import { element, notify } from "./elements.js";
import { SearchDialog } from "./search_dialog.js";

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
export class ObjectDialog extends SearchDialog {
  constructor(names) {
    super({
      id: "found-objects",
      className: "object-dialog",
      title: "Choose an object",
      symbol: "list",
      placeholder: "Search objects and materials",
      label: "Search objects and materials",
      listLabel: "Objects",
      none: "The frame has no such object.",
    });
    this.names = names;
    names.addEventListener("change", () => this.node.open && this.show());
  }

  /** `give(key)` gets what a look writes for the chosen one. */
  open(give) {
    this.give = give;
    this.names.load();
    this.openEmpty();
  }

  fill(words) {
    this.shown = this.names.list.filter((one) =>
      words.every((word) => `${keyOf(one)} ${one.kind}`.toLowerCase().includes(word)),
    );
    this.list.replaceChildren(
      ...this.shown.map((one) =>
        element(
          "div",
          { role: "option", class: "object" },
          element("span", { class: "name" }, String(keyOf(one))),
          element("span", { class: "kind" }, one.kind),
          element("span", { class: "share" }, share(one.share)),
        ),
      ),
    );
  }

  take(index) {
    const key = keyOf(this.shown[index]);
    this.node.close();
    this.give(key);
  }
}
