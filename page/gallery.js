// Looks to start from, as small pictures of this frame: what a look without steps shows.
import { get } from "./api.js";
import { element, notify } from "./elements.js";

const words = (name) => name.charAt(0).toUpperCase() + name.slice(1).replaceAll("_", " ");

export class Gallery {
  #shown = ""; // the capture whose looks are listed

  /** `taken()` follows once a look is chosen. */
  constructor(store, viewer, thumbnails, taken) {
    this.store = store;
    this.viewer = viewer;
    this.thumbnails = thumbnails;
    this.taken = taken;
    this.list = element("ul", { class: "starts" });
    this.others = element("p", { class: "empty" });
    this.node = element(
      "section",
      { class: "gallery", "aria-label": "Start from a look", hidden: true },
      element("h2", {}, "Start from a look"),
      this.list,
      this.others,
    );
  }

  show(isShown) {
    const { path } = this.store.state.capture;
    if (this.node.hidden && !isShown) return;
    this.node.hidden = !isShown;
    if (!isShown) return this.thumbnails.stop();
    if (this.#shown === path) return this.#wantAll();
    this.#shown = path;
    this.#load();
  }

  async #load() {
    try {
      const looks = await get("/api/starts", { frame: this.viewer.frame });
      this.list.replaceChildren(...looks.filter(({ text }) => text).map((look) => this.#item(look)));
      this.#showNeeds(looks.filter(({ needs }) => needs));
      this.#wantAll();
    } catch (error) {
      this.#shown = "";
      this.others.textContent = error.message;
    }
  }

  /** The looks that lack roles, and how the producer writes each of these. */
  #showNeeds(looks) {
    const roles = (needs) => needs.map(({ role }) => role).join(" and "),
      sentences = looks.map(({ name, needs }) => `${words(name)} needs ${roles(needs)}`),
      remedies = new Map(looks.flatMap(({ needs }) => needs.map(({ role, remedy }) => [role, remedy])));
    this.others.hidden = !looks.length;
    this.others.replaceChildren(
      `${sentences.join("; ")}: the capture has no such role. `,
      ...[...remedies].filter(([, remedy]) => remedy).map(([role, remedy]) => `For ${role}: ${remedy}. `),
    );
  }

  #wantAll() {
    for (const item of this.list.children) {
      const canvas = item.querySelector("canvas");
      if (!("drawn" in canvas.dataset)) this.thumbnails.want(canvas, [{ op: "text", value: item.dataset.text }]);
    }
  }

  #item({ name, summary, text }) {
    return element(
      "li",
      { "data-text": text },
      element(
        "button",
        { type: "button", class: "start", onclick: () => this.#take(name, text) },
        element("canvas", { width: 240, height: 135, "aria-hidden": "true" }),
        element("span", { class: "name" }, words(name)),
        element("span", { class: "summary" }, summary),
      ),
    );
  }

  async #take(name, text) {
    if (!(await this.store.edit([{ op: "text", value: text }]))) return;
    notify(`${words(name)} (Ctrl+Z goes back to no steps)`);
    this.taken();
  }
}
