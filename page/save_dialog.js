// Asks for the name of a look that has none, and saves it.
import { button, element, freshId } from "./elements.js";

export class SaveDialog {
  constructor(store) {
    this.store = store;
    this.name = element("input", {
      type: "text",
      class: "field text wide",
      "aria-label": "Name of the look",
      "aria-describedby": "save-where",
      autocomplete: "off",
      spellcheck: "false",
    });
    this.where = element("p", { class: "empty", id: "save-where" });
    this.refusal = element("p", { class: "refusal", role: "alert" });
    const form = element(
      "form",
      { method: "dialog" },
      element("div", { class: "help-head" }, element("h2", {}, "Save the look")),
      element("div", { class: "save-name" }, this.name, element("span", { class: "unit" }, ".json")),
      this.where,
      this.refusal,
      element(
        "div",
        { class: "save-foot" },
        button("Cancel", () => this.node.close()),
        element("button", { type: "submit", class: "save" }, "Save"),
      ),
    );
    this.node = element("dialog", { class: "save-dialog", "aria-label": "Save the look" }, form);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.#save();
    });
    this.store.addEventListener("fail", ({ detail }) => this.node.open && (this.refusal.textContent = detail.message));
    document.body.append(this.node);
  }

  /** Resolves once the dialog is closed: whether the look was saved. */
  open() {
    this.refusal.textContent = "";
    this.where.textContent = `In ${this.store.state.look.folder}`;
    this.node.showModal();
    this.name.focus();
    return new Promise((resolve) =>
      this.node.addEventListener("close", () => resolve(this.store.state.look.has_file), { once: true }),
    );
  }

  /** Asks whether a look with faults is to be saved. Resolves to the answer. */
  confirm() {
    const count = this.store.state.faults.filter(({ severity }) => severity !== "warning").length,
      heading = freshId("faulty");
    const node = element(
      "dialog",
      { class: "save-dialog", "aria-labelledby": heading },
      element(
        "form",
        { method: "dialog" },
        element(
          "div",
          { class: "help-head" },
          element("h2", { id: heading }, count === 1 ? "The look has a fault" : `The look has ${count} faults`),
        ),
        element("p", { class: "empty" }, "`aftershade run` refuses it until they are corrected. Save it all the same?"),
        element(
          "div",
          { class: "save-foot" },
          element("button", { value: "", autofocus: true }, "Cancel"),
          element("button", { value: "save" }, "Save with faults"),
        ),
      ),
    );
    document.body.append(node);
    node.showModal();
    return new Promise((resolve) =>
      node.addEventListener(
        "close",
        () => {
          node.remove();
          resolve(node.returnValue === "save");
        },
        { once: true },
      ),
    );
  }

  async #save() {
    const name = this.name.value.trim().replace(/\.json$/, "");
    if (!name) return (this.refusal.textContent = "Type a name");
    this.refusal.textContent = "";
    if (await this.store.save(name)) this.node.close();
  }
}
