// The look's variables: values by name, which parameters take by {"var": "name"}.
import { element, notify } from "./elements.js";
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

export class Variables {
  constructor(store) {
    this.store = store;
    this.rows = new Map();
    this.list = element("div");
    this.node = element(
      "section",
      { class: "variables", "aria-label": "Variables", hidden: true },
      element("h2", {}, "Variables"),
      this.list,
    );
  }

  update() {
    const { text, steps } = this.store.state,
      found = variablesOf(text);
    this.node.hidden = found.length === 0;
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
      const users = steps.flatMap((step) =>
        Object.entries(step.params).flatMap(([id, entry]) => (entry.value?.var === name ? [`${step.name}.${id}`] : [])),
      );
      row.hint.textContent = users.length ? `Value of ${users.join(", ")}.` : "No parameter takes this variable.";
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
    const node = element(
      "div",
      { class: "row", "data-variable": name },
      element("span", { class: "label" }, element("span", { class: "words" }, name)),
      element("div", { class: "controls" }, input),
      element("span", { class: "key-place" }),
      element("span", { class: "source", title: "Parameters that take it" }, count),
      error,
      hint,
    );
    node.addEventListener("refused", ({ detail }) => (error.textContent = detail ?? ""));
    return { node, show, hint, count };
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
