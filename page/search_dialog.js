// A dialog with a list that typing narrows, and arrow keys or a press choose from.
import { element, icon } from "./elements.js";

const PAGE = 8; // entries that Page Up and Page Down pass

export class SearchDialog {
  /** `id`: of the list. A kind of dialog has fill(words), which fills the list with options, and take(index of one). */
  constructor({ id, className, title, symbol, placeholder, label, listLabel, none }) {
    this.id = id;
    this.search = element("input", {
      type: "search",
      placeholder,
      "aria-label": label,
      role: "combobox",
      "aria-expanded": "true",
      "aria-controls": id,
      "aria-autocomplete": "list",
      autocomplete: "off",
      spellcheck: "false",
    });
    this.list = element("div", { id, class: "found", role: "listbox", "aria-label": listLabel });
    this.none = element("p", { class: "empty", hidden: true }, none);
    this.node = element(
      "dialog",
      { class: className, "aria-label": title },
      element("div", { class: "search" }, icon(symbol), this.search),
      this.list,
      this.none,
    );
    document.body.append(this.node);
    this.search.addEventListener("input", () => this.show());
    this.search.addEventListener("keydown", (event) => this.#onKey(event));
    this.node.addEventListener("click", (event) => event.target === this.node && this.node.close());
    this.list.addEventListener("click", ({ target }) => {
      const index = this.items.indexOf(target.closest("[role=option]"));
      if (index >= 0) this.take(index);
    });
  }

  openEmpty() {
    this.search.value = "";
    this.node.showModal();
    this.show();
    this.search.focus();
  }

  get items() {
    return [...this.list.querySelectorAll("[role=option]")];
  }

  show() {
    this.fill(this.search.value.toLowerCase().split(/\s+/).filter(Boolean));
    this.items.forEach((item, i) => (item.id = `${this.id}-${i}`));
    this.none.hidden = this.items.length > 0;
    this.#select(0);
  }

  #select(index) {
    const { items } = this;
    this.at = Math.min(Math.max(index, 0), items.length - 1);
    items.forEach((node, i) => node.setAttribute("aria-selected", String(i === this.at)));
    const node = items[this.at];
    if (node) this.search.setAttribute("aria-activedescendant", node.id);
    else this.search.removeAttribute("aria-activedescendant");
    if (this.at === 0)
      this.list.scrollTop = 0; // with the heading above it
    else node?.scrollIntoView({ block: "nearest" });
  }

  #onKey(event) {
    const by = { ArrowDown: 1, ArrowUp: -1, PageDown: PAGE, PageUp: -PAGE }[event.key];
    if (by) this.#select(this.at + by);
    else if (event.key === "Enter") this.items[this.at] && this.take(this.at);
    else return;
    event.preventDefault();
  }
}
