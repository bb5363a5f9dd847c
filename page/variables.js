// The look's variables: values by name, which parameters take by {"var": "name"}.
import { element, iconButton, notify, options } from "./elements.js";
import { readText, replaced } from "./json_text.js";
import { field } from "./number.js";
import { asText, fromText, isExpression, sourceOf } from "./values.js";

/** [[name, node], ...] of the look's text; none while it is not JSON. */
function variablesOf(text) {
  try {
    return [...(readText(text).members?.get("vars")?.members ?? [])];
  } catch {
    return [];
  }
}
export const variableNames = (text) => variablesOf(text).map(([name]) => name);

export const variableValue = (text, wanted) => variablesOf(text).find(([name]) => name === wanted)?.[1].value;

const NAME = /^[a-z][a-z0-9_]*$/;

/** {"step.param": {index, id, entry}, ...} of the parameters that have a value of their own to take. */
function parametersOf(steps) {
  const found = new Map();
  for (const step of steps)
    for (const [id, entry] of Object.entries(step.params))
      if (!entry.value?.var) found.set(`${step.name}.${id}`, { index: step.index, id, entry });
  return found;
}

export class Variables {
  constructor(store) {
    this.store = store;
    this.rows = new Map();
    this.list = element("div");
    this.addButton = iconButton("plus", "Add a variable", () => this.open(), { "aria-expanded": "false" });
    this.form = this.newForm();
    this.node = element(
      "section",
      { class: "variables", "aria-label": "Variables" },
      element("div", { class: "variables-head" }, element("h2", {}, "Variables"), this.addButton),
      this.list,
      this.form,
    );
  }

  /** A variable of a name and a value, or one that takes a parameter's value and sets it from then on. */
  newForm() {
    this.newParameter = element("select", { "aria-label": "Parameter that uses the variable" });
    this.newName = element("input", { type: "text", class: "field text", "aria-label": "Name of the variable", placeholder: "name" });
    this.newValue = element("input", { type: "text", class: "field text", "aria-label": "Value of the variable", placeholder: "value" });
    for (const input of [this.newName, this.newValue]) {
      input.autocomplete = "off";
      input.spellcheck = false;
    }
    this.newParameter.addEventListener("change", () => this.takeParameter());
    this.newError = element("p", { class: "refusal", role: "alert" });
    const form = element(
      "form",
      { class: "new-variable", "aria-label": "New variable", hidden: true },
      this.newParameter,
      this.newName,
      this.newValue,
      element("button", { type: "submit" }, "Add"),
      this.newError,
    );
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.add();
    });
    form.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      event.stopPropagation();
      this.close();
    });
    return form;
  }

  open() {
    if (!this.form.hidden) return this.close();
    this.form.hidden = false;
    this.addButton.setAttribute("aria-expanded", "true");
    this.newName.value = this.newValue.value = this.newError.textContent = "";
    this.newParameter.value = "";
    this.newParameter.focus();
  }
  close() {
    this.form.hidden = true;
    this.addButton.setAttribute("aria-expanded", "false");
    this.addButton.focus();
  }

  takeParameter() {
    const found = parametersOf(this.store.state.steps).get(this.newParameter.value);
    if (!found) return;
    const value = found.entry.value ?? found.entry.effective,
      names = variableNames(this.store.state.text);
    let name = found.id;
    for (let n = 2; names.includes(name); ++n) name = `${found.id}_${n}`;
    this.newName.value = name;
    this.newValue.value = value === null || isExpression(value) ? "" : asText(value);
  }

  async add() {
    const name = this.newName.value.trim(),
      words = this.newValue.value.trim();
    const refuse = (fault, input) => {
      this.newError.textContent = fault;
      input.focus();
    };
    if (!NAME.test(name)) return refuse("A name has small letters, digits and _", this.newName);
    if (variableNames(this.store.state.text).includes(name))
      return refuse(`The look has a variable ${name} already`, this.newName);
    if (!words) return refuse(`${name} needs a value`, this.newValue);
    let value;
    try {
      value = fromText(words);
    } catch (fault) {
      return refuse(fault.message, this.newValue);
    }
    const edits = [{ op: "var", name, value }],
      taker = parametersOf(this.store.state.steps).get(this.newParameter.value);
    if (taker) edits.push({ op: "set", step: taker.index, param: taker.id, value: { var: name } });
    if (!(await this.store.edit(edits))) return;
    this.close();
    notify(`Added the variable ${name}`);
  }

  /** The parameters that take it keep its value. */
  async remove(name) {
    const { steps, text } = this.store.state,
      value = variableValue(text, name),
      edits = steps.flatMap((step) =>
        Object.entries(step.params).flatMap(([id, entry]) =>
          entry.value?.var === name ? [{ op: "set", step: step.index, param: id, value }] : [],
        ),
      );
    if (await this.store.edit([...edits, { op: "var", name, value: null }])) this.addButton.focus();
  }

  /** Has the parameter take the variable. */
  bind(name, chosen) {
    const taker = parametersOf(this.store.state.steps).get(chosen);
    if (taker) this.store.edit([{ op: "set", step: taker.index, param: taker.id, value: { var: name } }]);
  }

  update() {
    const { text, steps } = this.store.state,
      found = variablesOf(text),
      takers = [...parametersOf(steps).keys()].map((one) => [one, one]);
    options(this.newParameter, [["", "for no parameter yet"], ...takers], this.newParameter.value);
    const names = new Set(found.map(([name]) => name));
    for (const [name, { node }] of this.rows)
      if (!names.has(name)) {
        node.remove();
        this.rows.delete(name);
      }
    for (const [i, [name, { value }]] of found.entries()) {
      if (!this.rows.has(name)) this.rows.set(name, this.row(name));
      const row = this.rows.get(name);
      // A node that is moved loses the focus.
      if (this.list.children[i] !== row.node) this.list.insertBefore(row.node, this.list.children[i] ?? null);
      row.show(asText(value));
      options(row.taker, [["", "Use for…"], ...takers], "");
      const users = steps.flatMap((step) =>
        Object.entries(step.params).flatMap(([id, entry]) => (entry.value?.var === name ? [`${step.name}.${id}`] : [])),
      );
      row.hint.textContent = users.length ? `Value of ${users.join(", ")}.` : "No parameter uses this variable.";
      row.count.textContent = users.length;
    }
  }

  row(name) {
    const hint = element("p", { class: "hint" }),
      count = element("span", { class: "tag" }),
      error = element("p", { class: "refusal", role: "alert" });
    const { node: input, show } = field({
      label: `Variable ${name}`,
      className: "field wide text",
      parse: (text) => {
        try {
          return text.trim() ? { value: fromText(text) } : { error: `${name} needs a value` };
        } catch (fault) {
          return { error: fault.message };
        }
      },
      commit: (value) => this.set(name, value),
    });
    const taker = element("select", {
      class: "taker",
      "aria-label": `Parameter that takes ${name}`,
      title: `Choose a parameter that takes ${name}`,
    });
    taker.addEventListener("change", () => this.bind(name, taker.value));
    const node = element(
      "div",
      { class: "row", "data-variable": name },
      element("span", { class: "label" }, element("span", { class: "words" }, name)),
      element("div", { class: "controls" }, element("span", { class: "wide bound" }, input, taker)),
      iconButton("remove", `Remove the variable ${name}; its parameters keep the value`, () => this.remove(name), {
        class: "icon-button key",
      }),
      element("span", { class: "source", title: "Parameters that use it" }, count),
      error,
      hint,
    );
    node.addEventListener("refused", ({ detail }) => (error.textContent = detail ?? ""));
    return { node, show, hint, count, taker };
  }

  async set(name, value) {
    const { text } = this.store.state,
      [, found] = variablesOf(text).find(([one]) => one === name) ?? [];
    if (!found) return notify(`The look has no variable ${name}`, true);
    return this.store.edit([{ op: "text", value: replaced(text, found, value) }]);
  }
}

/** A parameter that takes a variable: which one, its value, and a way back to a value of its own. */
export function variableControl({ label, describedBy, commit, variables, unit = "" }) {
  const select = element("select", { "aria-label": `Variable of ${label}`, "aria-describedby": describedBy }),
    now = element("span", { class: "unit now-value" });
  select.title = sourceOf("variable").words;
  select.addEventListener("change", () => commit({ var: select.value }));
  let own = null;
  const unbind = element(
    "button",
    {
      type: "button",
      title: `Unbind: ${label} keeps the value that the variable has`,
      "aria-label": `Unbind ${label}`,
      onclick: () => commit(own),
    },
    "Unbind",
  );
  return {
    nodes: [element("span", { class: "wide bound" }, select, now, unbind)],
    update({ value, effective }) {
      const names = variables.names();
      if (!names.includes(value.var)) names.push(value.var);
      select.replaceChildren(...names.map((name) => element("option", { value: name }, name)));
      select.value = value.var;
      // Of a step that is disabled the program gives the variable as it is written.
      own = isExpression(effective) ? variables.value(value.var) : effective;
      const isKnown = own !== null && own !== undefined;
      unbind.disabled = !isKnown;
      now.textContent = isKnown ? `${asText(own)}${typeof own === "number" && unit ? ` ${unit}` : ""}` : "";
    },
  };
}
