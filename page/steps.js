// The look as a list of steps: order, names, presets and, opened, the parameters of each.
import { button, element, freshId, icon, iconButton, notify, options } from "./elements.js";
import { field } from "./number.js";
import { parameterRow } from "./controls.js";
import { maskRow } from "./mask.js";
import { variableNames, variableValue, Variables } from "./variables.js";
import { milliseconds } from "./values.js";

const MIX = {
  type: "float",
  min: 0,
  max: 1,
  ui: [0, 1],
  default: 1,
  doc: "Blend from the image before the step to its result.",
};

/** A step that includes another look has no effect, but its file. */
export const nameOf = (step) => step.name || step.effect || (step.use ? `use ${step.use}` : `step ${step.index + 1}`);

/** Places of rows: those without a section first, then each section under its heading, the advanced ones in a fold. */
class Sections {
  #nodes = new Map();

  constructor(body, params) {
    this.params = params;
    this.first = element("div");
    this.advanced = element("details", { class: "advanced", hidden: true }, element("summary", {}, "Advanced"));
    body.append(this.first, this.advanced);
  }

  add(id, { section = "", advanced = false }, row) {
    if (advanced) {
      this.advanced.hidden = false;
      this.advanced.append(row);
      if (this.params[id]?.value !== undefined) this.advanced.open = true; // the look has a word on it
    } else if (!section) this.first.append(row);
    else {
      if (!this.#nodes.has(section)) {
        const heading = freshId("section"),
          node = element(
            "div",
            { class: "section", role: "group", "aria-labelledby": heading },
            element("p", { id: heading, class: "section-name" }, section),
          );
        this.#nodes.set(section, node);
        this.advanced.before(node);
      }
      this.#nodes.get(section).append(row);
    }
  }
}

class StepCard {
  constructor(list, step, key) {
    this.list = list;
    this.key = key;
    this.index = step.index;
    this.effect = list.store.effects.get(step.effect); // undefined for "use" and for effects that are not found
    this.rows = new Map();
    this.build(step);
  }

  edit(edit, gesture = null) {
    return this.list.store.edit([{ step: this.index, ...edit }], gesture && `${this.key} ${gesture}`);
  }

  build(step) {
    const body = freshId("step");
    this.box = element("input", { type: "checkbox", title: "Enable (E)" });
    this.box.addEventListener("change", () => this.edit({ op: "enable", value: this.box.checked }));
    this.title = element("span", { class: "name" });
    this.id = element("span", { class: "id" });
    this.cost = element("span", { class: "cost" });
    this.opener = element(
      "button",
      {
        type: "button",
        class: "opener",
        "aria-expanded": "false",
        "aria-controls": body,
        onclick: () => this.toggle(),
      },
      icon("caret"),
      this.title,
      this.id,
    );
    this.grip = element("span", { class: "grip", title: "Drag to move (Alt+↑, Alt+↓)" }, icon("grip"));
    this.up = iconButton("up", "Move up", () => this.list.move(this, -1), { shortcut: "Alt+ArrowUp" });
    this.down = iconButton("down", "Move down", () => this.list.move(this, 1), { shortcut: "Alt+ArrowDown" });
    this.body = element("div", { class: "body", id: body, hidden: true });
    this.fault = element("p", { class: "step-fault", role: "alert", hidden: true });
    this.node = element(
      "li",
      { class: "step", "data-step": nameOf(step) },
      element(
        "div",
        { class: "head" },
        this.grip,
        this.box,
        this.opener,
        this.cost,
        this.up,
        this.down,
        iconButton("remove", "Remove", () => this.list.remove(this), { shortcut: "Delete" }),
      ),
      this.fault,
      this.body,
    );
    this.node.addEventListener("keydown", (event) => this.onKey(event));
    this.enableDrag();
  }

  buildBody() {
    this.isBuilt = true;
    this.name = field({
      label: "Name",
      className: "field wide text",
      parse: (text) => ({ value: text.trim() }),
      commit: (value) => this.edit({ op: "name", value }),
    });
    this.preset = element("select", { class: "wide", "aria-label": "Preset" });
    this.preset.addEventListener("change", () => this.edit({ op: "preset", value: this.preset.value || null }));
    const { time } = this.list,
      text = () => this.list.store.state.text,
      variables = { names: () => variableNames(text()), value: (name) => variableValue(text(), name) };
    this.mix = parameterRow({
      id: "mix",
      parameter: MIX,
      commit: (value, gesture) => this.edit({ op: "mix", value }, gesture),
      time,
      variables,
    });
    const { objects } = this.list;
    this.mask = maskRow({ commit: (value) => this.edit({ op: "mask", value }), objects });
    const line = (label, ...nodes) =>
      element(
        "div",
        { class: "row" },
        element("span", { class: "label" }, label),
        element("div", { class: "controls" }, nodes),
        element("span", { class: "key-place" }),
        element("span", { class: "source" }),
      );
    const hasPresets = Object.keys(this.effect?.presets ?? {}).length > 0;
    this.body.replaceChildren(
      ...(this.effect ? [element("p", { class: "summary" }, this.effect.summary)] : []),
      line("name", this.name.node),
      ...(hasPresets ? [line("preset", this.preset)] : []),
      this.mix.node,
      this.mask.node,
    );
    const sections = new Sections(this.body, this.step.params);
    for (const [id, parameter] of Object.entries(this.effect?.params ?? {})) {
      const row = parameterRow({
        id,
        parameter,
        commit: (value, gesture) => this.edit({ op: "set", param: id, value }, gesture && `${id} ${gesture}`),
        pick: this.list.pickFor(parameter),
        time,
        variables,
        objects,
        measured: () => time.measured.get(`${nameOf(this.step)}.${id}`),
      });
      row.node.dataset.param = id;
      this.rows.set(id, row);
      sections.add(id, parameter, row.node);
    }
  }

  toggle(isOpen = this.body.hidden) {
    if (isOpen && !this.isBuilt) this.buildBody();
    this.body.hidden = !isOpen;
    this.opener.setAttribute("aria-expanded", String(isOpen));
    this.list.opened[isOpen ? "add" : "delete"](this.key);
    if (isOpen) this.updateBody();
  }

  update(step, count) {
    this.step = step;
    this.index = step.index;
    const name = nameOf(step);
    this.title.textContent = name;
    this.id.textContent = name === step.effect ? "" : (step.effect ?? "");
    this.opener.title = this.effect?.summary ?? "";
    this.node.dataset.step = name;
    this.node.setAttribute("aria-label", name);
    this.box.setAttribute("aria-label", `Enable ${name}`);
    this.box.checked = step.enabled;
    this.node.classList.toggle("off", !step.enabled);
    this.up.disabled = step.index === 0;
    this.down.disabled = step.index === count - 1;
    if (!this.body.hidden) this.updateBody();
  }

  updateBody() {
    const { step } = this;
    if (!step) return;
    this.name.show(step.name || step.effect || "");
    options(
      this.preset,
      [["", "none"], ...Object.keys(this.effect?.presets ?? {}).map((name) => [name, name])],
      step.preset ?? "",
    );
    const { state } = this.list.store,
      isSet = step.mix !== null && step.mix !== undefined,
      isVariable = typeof step.mix?.var === "string",
      number = isVariable ? variableValue(state.text, step.mix.var) : step.mix;
    this.mix.update({
      effective: typeof number === "number" ? number : MIX.default,
      value: isSet ? step.mix : undefined,
      from: isVariable ? "variable" : isSet ? "look" : "default",
    });
    this.mask.update(step.mask, state.capture.roles);
    for (const [id, row] of this.rows)
      row.update(step.params[id] ?? { effective: this.effect.params[id].default, from: "default" });
  }

  /** The scrubber is at another frame: of keys over frames, other values count. */
  showFrame() {
    if (this.body.hidden) return;
    this.mix.showFrame();
    for (const row of this.rows.values()) row.showFrame();
  }

  onKey(event) {
    const isHead = event.target.closest(".head");
    if (event.altKey && event.key === "ArrowUp") this.list.move(this, -1);
    else if (event.altKey && event.key === "ArrowDown") this.list.move(this, 1);
    else if (isHead && event.key === "Delete") this.list.remove(this);
    else if (isHead && event.key === "ArrowUp") this.list.focus(this.index - 1);
    else if (isHead && event.key === "ArrowDown") this.list.focus(this.index + 1);
    else if (isHead && event.key === "e" && !event.ctrlKey) this.box.click();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** Shows heads alone while a step is dragged, so that all places are near; the grip stays under the pointer. */
  fold(isFolded) {
    const { top } = this.grip.getBoundingClientRect();
    this.list.list.classList.toggle("folded", isFolded);
    this.list.node.scrollTop += this.grip.getBoundingClientRect().top - top;
  }

  /** By the pointer: the grip takes the step along, and a line shows where it will be. */
  enableDrag() {
    this.grip.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      this.grip.setPointerCapture(event.pointerId);
      this.node.classList.add("dragged");
      this.fold(true);
      const others = [...this.list.list.children];
      let to = this.index;
      const move = ({ clientY }) => {
        const over = others.findIndex((node) => {
          const box = node.getBoundingClientRect();
          return clientY < box.top + Math.min(box.height, 40) / 2;
        });
        const gap = over === -1 ? others.length : over;
        others.forEach((node, i) => node.classList.toggle("before-gap", i === gap));
        this.list.list.classList.toggle("gap-at-end", gap === others.length);
        to = gap > this.index ? gap - 1 : gap;
      };
      const end = ({ type }) => {
        this.grip.removeEventListener("pointermove", move);
        others.forEach((node) => node.classList.remove("before-gap"));
        this.list.list.classList.remove("gap-at-end");
        this.node.classList.remove("dragged");
        this.fold(false);
        if (type === "pointerup" && to !== this.index) this.list.move(this, to - this.index);
      };
      this.grip.addEventListener("pointermove", move);
      this.grip.addEventListener("pointerup", end, { once: true });
      this.grip.addEventListener("pointercancel", end, { once: true });
    });
  }
}

export class StepList {
  /**
   * `time`: {frame, frames, setFrame(frame), measured} of the viewer; `objects`: {names, pick, choose} of the frame; `gallery`: what a look without steps shows.
   */
  constructor(store, { add, pickFor, objects, time, gallery }) {
    this.store = store;
    this.pickFor = pickFor;
    this.objects = objects;
    this.time = time;
    this.gallery = gallery;
    this.cards = [];
    this.opened = new Set();
    this.list = element("ol", { class: "steps", id: "steps", "aria-label": "Steps" });
    this.variables = new Variables(store);
    objects.names.addEventListener("change", () => this.store.state && this.update());
    this.empty = element("p", { class: "empty" }, "No steps. The picture is the capture's colour.");
    this.node = element(
      "div",
      { class: "scroll" },
      this.variables.node,
      this.list,
      this.empty,
      button([icon("plus"), "Add a step"], add, { class: "add", title: "Add a step (A)" }),
      gallery.node,
    );
  }

  update() {
    this.variables.update();
    const { steps } = this.store.state,
      // An effect that was declared anew has other parameters. Each reading of the effects makes new objects.
      isCurrent = ({ effect, step }) => {
        const now = this.store.effects.get(step.effect);
        return effect === now || JSON.stringify(effect) === JSON.stringify(now);
      },
      left = new Map(this.cards.filter(isCurrent).map((card) => [card.key, card])),
      counts = new Map(),
      isFirst = this.cards.length === 0 && !this.hasShown;
    const keys = steps.map((step) => {
      const name = `${step.effect ?? ""} ${nameOf(step)}`,
        count = counts.get(name) ?? 0;
      counts.set(name, count + 1);
      return `${name} ${count}`;
    });
    // A renamed step keeps its card.
    const fresh = keys.filter((key) => !left.has(key)),
      gone = [...left.keys()].filter((key) => !keys.includes(key));
    if (fresh.length === 1 && gone.length === 1 && fresh[0].split(" ")[0] === gone[0].split(" ")[0]) {
      const card = left.get(gone[0]);
      left.delete(gone[0]);
      if (this.opened.delete(gone[0])) this.opened.add(fresh[0]);
      card.key = fresh[0];
      left.set(card.key, card);
    }
    this.cards = keys.map((key, i) => left.get(key) ?? new StepCard(this, steps[i], key));
    const active = document.activeElement;
    this.cards.forEach((card, i) => {
      if (this.list.children[i] !== card.node) this.list.insertBefore(card.node, this.list.children[i] ?? null);
      card.update(steps[i], steps.length);
      if (this.opened.has(card.key) && card.body.hidden) card.toggle(true);
    });
    while (this.list.children.length > this.cards.length) this.list.lastChild.remove();
    if (active !== document.activeElement && active?.isConnected) active.focus();
    this.empty.hidden = this.cards.length > 0;
    this.gallery.show(this.cards.length === 0 && !this.store.state.read_only);
    if (isFirst && this.cards.length) this.cards[0].toggle(true);
    this.hasShown = true;
  }

  showFrame() {
    for (const card of this.cards) card.showFrame();
  }

  /** {step, message} of what the frame lacks for a step; undefined: it lacks nothing. */
  showFault(fault) {
    for (const card of this.cards) {
      const isAtFault = fault !== undefined && nameOf(card.step) === fault.step;
      card.fault.hidden = !isAtFault;
      card.fault.textContent = isAtFault ? fault.message : "";
    }
  }

  /** Milliseconds of each step, by name. */
  showCosts(passes) {
    for (const card of this.cards) {
      const name = nameOf(card.step),
        own = passes.filter(({ step }) => step === name);
      card.cost.textContent = own.length ? milliseconds(own.reduce((sum, { ms }) => sum + ms, 0)) : "";
      card.cost.title = own.length ? "Time of its passes in the last full picture" : "";
    }
  }

  focus(index) {
    this.cards[Math.min(Math.max(index, 0), this.cards.length - 1)]?.opener.focus();
  }

  async move(card, by) {
    const to = card.index + by;
    if (to < 0 || to >= this.cards.length) return;
    const { key } = card;
    if (await this.store.edit([{ op: "move", step: card.index, to }])) {
      this.cards.find((one) => one.key === key)?.opener.focus();
      notify(`${card.title.textContent} is step ${to + 1} of ${this.cards.length}`);
    }
  }

  async remove(card) {
    const { index } = card,
      name = card.title.textContent;
    if (!(await this.store.edit([{ op: "remove", step: index }]))) return;
    notify(`${name} removed (Ctrl+Z brings it back)`);
    if (this.cards.length) this.focus(index);
    else this.node.querySelector(".add").focus();
  }
}
