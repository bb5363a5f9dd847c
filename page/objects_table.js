// Values by object: a line for each object or range of objects, one for the others, and one to add.
import { element, iconButton, options } from "./elements.js";
import { field } from "./number.js";
import * as values from "./values.js";

/** The text of a line's objects, and the line's key for such a text: an id, ranges of ids, or a name. */
const objectsOf = ({ object, objects, name }, names) =>
  String(name ?? objects ?? (object === undefined ? "" : names.words(object)));
/** The line's key for an object that was picked or chosen. */
const lineOf = (key) => (typeof key === "number" ? { object: key } : { name: key });
export function keyFrom(text) {
  const trimmed = text.trim();
  if (!trimmed) return { error: "examples: 2, 3-7, Wheel" };
  if (/^\d+$/.test(trimmed)) return { value: { object: Number(trimmed) } };
  return { value: /^[\d,\s-]+$/.test(trimmed) ? { objects: trimmed.replaceAll(/\s/g, "") } : { name: trimmed } };
}

/** {node, update(value)} for one value of a column. */
function cell({ label, column, commit, listId }) {
  if (column.type === "bool") {
    const node = element("input", { type: "checkbox", "aria-label": label, title: column.doc });
    node.addEventListener("change", () => commit(node.checked));
    return { node, update: (value) => (node.checked = value === true) };
  }
  if (column.type === "enum") {
    const node = element("select", { "aria-label": label, title: column.doc });
    node.addEventListener("change", () => commit(node.value));
    const names = column.values.map((name) => [name, name]);
    return { node, update: (value) => options(node, names, value) };
  }
  let now;
  const isNumber = values.isNumeric(column.type);
  const { node, show } = field({
    label,
    className: isNumber ? "field" : "field text",
    inputmode: isNumber ? "decimal" : null,
    parse: (text) => {
      if (isNumber) return values.typedNumber(text, column, now);
      try {
        return { value: values.fromText(text) };
      } catch (error) {
        return { error: error.message };
      }
    },
    commit,
  });
  if (listId) node.setAttribute("list", listId);
  return { node, update: (value) => show(values.asText((now = value))) };
}

/**
 * {node, update(rows, others)}. `columns`: {name: declaration}; `others`, if the value has it, the values of all other objects.
 * `onRows(rows)` and `onOthers(name, value)` take changes; `objects`: {names, pick(node, take), choose(take)} of the frame.
 */
export function objectsTable({ label, columns, hasOthers, onRows, onOthers, objects, listId }) {
  const names = Object.keys(columns),
    lines = [];
  let rows = [];
  const body = element("tbody");
  const others =
    hasOthers &&
    names.map((name) =>
      cell({
        label: `${label}, others, ${name}`,
        column: columns[name],
        commit: (value) => onOthers(name, value),
        listId,
      }),
    );
  const add = field({
    label: `${label}, object to add`,
    className: "field text",
    parse: keyFrom,
    commit: async (key) => {
      await onRows([...rows, { ...key, ...fresh() }]);
      add.show("");
      add.node.value = "";
    },
  });
  add.node.placeholder = "2, 3-7, Wheel";
  const picker = iconButton("pick", `Pick an object for ${label}`, () => objects.pick(picker, addLine), {
    class: "icon-button picker",
    "aria-pressed": "false",
  });
  const chooser = iconButton("list", `Choose an object for ${label} from a list`, () => objects.choose(addLine));
  const addLine = (key) => onRows([...rows, { ...lineOf(key), ...fresh() }]);
  // A profile has no default of its own: a new line begins with one that can be seen.
  const fresh = () =>
    Object.fromEntries(names.filter((name) => columns[name].begin).map((name) => [name, columns[name].begin]));
  const last = element(
    "tr",
    {},
    element("td", {}, add.node),
    element(
      "td",
      { colspan: names.length, class: "quiet" },
      element("span", { class: "adds" }, "adds a line", chooser),
    ),
    element("td", {}, picker),
  );
  const othersLine =
    others &&
    element(
      "tr",
      {},
      element("th", { scope: "row" }, "others"),
      others.map(({ node }) => element("td", {}, node)),
      element("td"),
    );
  const node = element(
    "table",
    { class: "objects-table", "aria-label": label },
    element(
      "thead",
      {},
      element(
        "tr",
        {},
        ["object", ...names].map((name) => element("th", { scope: "col" }, name.replaceAll("_", " "))),
        element("td"),
      ),
    ),
    body,
  );
  body.append(...(othersLine ? [othersLine] : []), last);

  const put = (i, row) => onRows(rows.map((old, at) => (at === i ? row : old)));
  function line(i) {
    const object = field({
      label: `${label}, objects of line ${i + 1}`,
      className: "field text",
      parse: keyFrom,
      commit: (key) => {
        const { object: _, objects: __, name: ___, ...rest } = rows[i];
        return put(i, { ...key, ...rest });
      },
    });
    const cells = names.map((name) =>
      cell({
        label: `${label}, line ${i + 1}, ${name}`,
        column: columns[name],
        commit: (value) => put(i, { ...rows[i], [name]: value }),
        listId,
      }),
    );
    const remove = iconButton("remove", `Remove line ${i + 1} of ${label}`, () => {
      onRows(rows.toSpliced(i, 1));
      (lines[i - 1]?.object.node ?? add.node).focus();
    });
    const tr = element(
      "tr",
      {},
      element("td", {}, object.node),
      cells.map((one) => element("td", {}, one.node)),
      element("td", {}, remove),
    );
    return { tr, object, cells };
  }
  return {
    node,
    update(next, defaults = {}) {
      rows = next;
      const valueOf = (name, row) => row[name] ?? defaults[name] ?? columns[name].default;
      others && others.forEach((one, i) => one.update(valueOf(names[i], {})));
      while (lines.length > rows.length) lines.pop().tr.remove();
      while (lines.length < rows.length) {
        lines.push(line(lines.length));
        body.insertBefore(lines.at(-1).tr, last);
      }
      rows.forEach((row, i) => {
        lines[i].object.show(objectsOf(row, objects.names));
        lines[i].cells.forEach((one, at) => one.update(valueOf(names[at], row)));
      });
    },
  };
}

const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);

/** The control of a parameter of type table. */
export function tableControl({ label, parameter, commit, objects }) {
  let value = {};
  const send = (next) => {
    const { rows = [], default: others = {}, ...rest } = next;
    const kept = {
      ...rest,
      ...(Object.keys(others).length ? { default: others } : {}),
      ...(rows.length ? { rows } : {}),
    };
    return commit(Object.keys(kept).length ? kept : null);
  };
  const table = objectsTable({
    label,
    columns: parameter.columns,
    hasOthers: true,
    onRows: (rows) => send({ ...value, rows }),
    onOthers: (name, one) => send({ ...value, default: { ...value.default, [name]: one } }),
    objects,
  });
  return {
    nodes: [element("div", { class: "wide" }, table.node)],
    isTall: true,
    update(entry) {
      const now = entry.value ?? (entry.from === "preset" ? entry.effective : {});
      value = isObject(now) ? now : {};
      table.update(value.rows ?? [], value.default);
    },
  };
}
