// A row for each parameter, made from its declaration in the effect's manifest.
import { curveControl } from "./curve.js";
import { element, icon, freshId, iconButton, options } from "./elements.js";
import { canBeKeyed, isKeyed, Keyed, numbersOf } from "./keyed.js";
import { field, numberControl } from "./number.js";
import { tableControl } from "./objects_table.js";
import { profileControl } from "./profile.js";
import { isPixelSource, rackControl, sourceControl } from "./source.js";
import * as values from "./values.js";
import { variableControl } from "./variables.js";
import { wheel } from "./wheel.js";

function boolControl({ label, describedBy, commit }) {
  const box = element("input", { type: "checkbox", "aria-label": label, "aria-describedby": describedBy });
  box.addEventListener("change", () => commit(box.checked));
  return {
    nodes: [element("span", { class: "wide" }, box)],
    update: ({ effective }) => (box.checked = effective === true),
  };
}

function enumControl({ label, parameter, describedBy, commit }) {
  const select = element("select", { class: "wide", "aria-label": label, "aria-describedby": describedBy });
  select.addEventListener("change", () => commit(select.value));
  const names = parameter.values.map((name) => [name, name]);
  return { nodes: [select], update: ({ effective }) => options(select, names, effective) };
}

function vectorControl({ label, parameter, describedBy, commit }) {
  const isColor = parameter.type === "color",
    names = isColor ? ["red", "green", "blue"] : ["x", "y", "z", "w"].slice(0, Number(parameter.type.slice(3)));
  let entry = { effective: parameter.default };
  const list = (value) => (Array.isArray(value) && value.length === names.length ? value : parameter.default);
  const now = () => [...list(entry.value ?? entry.effective)];
  const fields = names.map((name, i) =>
    field({
      label: `${label}, ${name}`,
      describedBy,
      inputmode: "decimal",
      parse: (text) => values.typedNumber(text, parameter, now()[i]),
      commit: (value) => commit(now().map((old, at) => (at === i ? value : old))),
      onArrow: (sign, times) => {
        const [low, high] = parameter.ui ?? [0, 1];
        const number = Number(
          (values.numberOf(list(entry.effective)[i], parameter.unit) + (sign * times * (high - low)) / 100).toPrecision(
            6,
          ),
        );
        if (!values.outOfRange(number, parameter)) {
          const all = now().map((old, at) => (at === i ? number : old));
          entry = {
            ...entry,
            effective: list(entry.effective).map((old, at) => (at === i ? number : old)),
            value: all,
          };
          fields[i].show(values.short(number));
          commit(all, `keys ${label} ${name}`);
        }
      },
    }),
  );
  const swatch =
    isColor && element("input", { type: "color", "aria-label": `${label}, swatch`, "aria-describedby": describedBy });
  if (swatch) swatch.addEventListener("input", () => commit(values.lightOf(swatch.value), `swatch ${label}`));
  const [low, high] = parameter.ui ?? [0, 1],
    disc =
      isColor &&
      wheel({
        label,
        reach: (high - low) / 4, // a grade shifts little
        change(numbers, gesture) {
          const inside = numbers.map((number) =>
            Number(Math.min(Math.max(number, parameter.min ?? -Infinity), parameter.max ?? Infinity).toPrecision(4)),
          );
          disc.show(inside);
          inside.forEach((number, i) => fields[i].show(values.short(number)));
          commit(inside, gesture);
        },
      });
  return {
    isTall: isColor,
    nodes: [
      element(
        "span",
        { class: "wide vector" },
        disc ? disc.node : null,
        swatch || null,
        fields.map(({ node }) => node),
      ),
    ],
    update(next) {
      entry = next;
      const numbers = list(next.effective).map((one) => values.numberOf(one, parameter.unit));
      numbers.forEach((number, i) => fields[i].show(values.short(number)));
      if (disc && numbers.every(Number.isFinite)) disc.show(numbers);
      if (swatch) swatch.value = values.swatchOf(numbers);
    },
  };
}

/** Objects by their names; the button adds one of the frame's. */
function objectsControl({ label, describedBy, commit, objects }) {
  let value = [];
  const { node, show } = field({
    label,
    describedBy,
    className: "field text",
    parse: (text) => ({ value: values.objectsFrom(text) }),
    commit,
  });
  const chooser = iconButton("list", `Choose objects of ${label} from a list`, () =>
    objects.choose((key) => commit([...value.filter((one) => one !== key), key])),
  );
  return {
    nodes: [element("span", { class: "wide vector" }, node, chooser)],
    update(entry) {
      const now = entry.value ?? entry.effective ?? "";
      value = Array.isArray(now) ? now : [];
      show(values.objectsText(now, objects.names.words));
    },
  };
}

function textControl({ label, describedBy, commit }, toText, parse) {
  const { node, show } = field({ label, describedBy, className: "field wide text", parse, commit });
  return { nodes: [node], update: (entry) => show(toText(entry.value ?? entry.effective ?? "")) };
}
const anyValue = (text) => {
  try {
    return { value: values.fromText(text) };
  } catch (error) {
    return { error: error.message };
  }
};

function controlFor(context) {
  const { parameter } = context;
  if (values.isNumeric(parameter.type)) return numberControl(context);
  if (values.isVector(parameter.type)) return vectorControl(context);
  if (parameter.type === "bool") return boolControl(context);
  if (parameter.type === "enum") return enumControl(context);
  if (parameter.type === "objects") return objectsControl(context);
  if (parameter.type === "file" || parameter.type === "text")
    return textControl(context, values.asText, (text) => ({ value: text.trim() }));
  if (parameter.type === "table") return tableControl(context);
  if (parameter.type === "scattering_profile") return profileControl(context);
  return textControl(context, values.asText, anyValue);
}

function rangeWords({ type, ui, min, max, unit = "", default: fallback }) {
  const parts = [
    `default ${values.asText(fallback) || "none"}${unit && typeof fallback === "number" ? ` ${unit}` : ""}`,
  ];
  const end = (number) => `${values.short(number, 7)}${unit && ` ${unit}`}`;
  if (min !== undefined && max !== undefined) parts.push(`limits ${values.short(min, 7)} to ${end(max)}`);
  else if (min !== undefined) parts.push(`at least ${end(min)}`);
  else if (max !== undefined) parts.push(`at most ${end(max)}`);
  if (ui && values.isNumeric(type)) parts.push(`slider ${values.short(ui[0])} to ${values.short(ui[1])}`);
  return parts.join("; ");
}

/**
 * {node, update(entry)} of a parameter. `commit(value, gesture)` sets it, null takes the key out of the look; `pick`, if
 * given, {click(node, take), choose(take)}: the next click in the picture or a choice from the list of objects sets it.
 * `time` is the scrubber, for keys; `variables`: {names(), value(name)} of the look; `objects`: {names, pick(node, take),
 * choose(take)} of the frame; `measured()` the number that the last picture took from the frame.
 */
export function parameterRow({ id, parameter, commit, pick, time, variables, objects, measured }) {
  const describedBy = freshId("doc"),
    label = id.replaceAll("_", " "),
    holder = element("div", { class: "controls" }),
    tag = element("span", { class: "tag" }),
    error = element("p", { class: "refusal", role: "alert" }),
    reset = iconButton("reset", `Reset ${label}`, () => commit(null), { class: "icon-button reset" });
  const picker =
    pick &&
    iconButton("pick", `Pick ${label} in the picture`, () => pick.click(picker, take), {
      class: "icon-button picker",
      "aria-pressed": "false",
    });
  const chooser =
    pick?.choose && iconButton("list", `Choose the object of ${label} from a list`, () => pick.choose(take));
  const key =
    canBeKeyed(parameter) && iconButton("keys", `Key ${label}`, () => toggleKey(), { class: "icon-button key" });
  const node = element(
    "div",
    { class: "row" },
    element(
      "span",
      { class: "label", title: parameter.doc },
      element("span", { class: "words" }, label),
      chooser || null,
      picker || null,
    ),
    holder,
    element("span", { class: "key-place" }, key || null),
    element("span", { class: "source" }, tag, reset),
    error,
    element("p", { class: "hint", id: describedBy }),
  );
  const hint = node.lastChild;
  node.addEventListener("refused", ({ detail }) => (error.textContent = detail ?? ""));

  let control = null,
    kind = null,
    entry = {};
  const hasKeyNow = () => isKeyed(entry.value) && String(time.frame) in entry.value.keys;
  /** A value that was picked: the value of this frame where there are keys. */
  function take(value) {
    if (!isKeyed(entry.value)) return commit(value);
    commit(new Keyed(entry.value).withLiteral(time.frame, value));
  }
  /** Adds a key at the scrubber's frame, or takes that frame's key out; the last one leaves its value. */
  function toggleKey() {
    const { frame } = time,
      { value } = entry;
    if (!isKeyed(value)) {
      const { effective } = entry,
        // Of a step that is disabled the program gives an expression as it is written.
        found = values.isExpression(effective) ? variables.value(effective.var) : effective,
        now = value === undefined || values.isExpression(value) ? (found ?? parameter.default) : value;
      // A focus that goes from one object to another eases out of the first and into the second.
      return commit(
        isPixelSource(value) ? { keys: { [frame]: value }, interpolation: "smooth" } : { keys: { [frame]: now } },
      );
    }
    const keyed = new Keyed(value),
      { keys } = keyed,
      index = keys.findIndex((key) => key.frame === frame);
    if (index >= 0) return commit(keyed.without(index));
    const distance = (key) => Math.abs(key.frame - frame);
    if (kindOf(entry) === "rack")
      return commit(keyed.withLiteral(frame, keys.reduce((a, b) => (distance(b) < distance(a) ? b : a)).literal));
    const style = keys[0].literal,
      numbers = keyed.numbersAt(frame, parameter).map((number) => Number(number.toPrecision(6)));
    commit(keyed.withLiteral(frame, Array.isArray(style) ? numbers : values.literal(numbers[0], parameter, style)));
  }
  function showFrame() {
    control?.showFrame?.();
    if (!key) return;
    const isKey = hasKeyNow();
    key.setAttribute("aria-pressed", String(isKey));
    key.classList.toggle("animated", isKeyed(entry.value));
    key.title = isKey ? `Remove the key at frame ${time.frame}` : `Key this value at frame ${time.frame}`;
  }
  const kindOf = ({ value }) => {
    const keys = isKeyed(value) && canBeKeyed(parameter) ? new Keyed(value).keys.map(({ literal }) => literal) : [];
    if (keys.some(isPixelSource)) return "rack";
    if (keys.length && keys.every((one) => numbersOf(one).every(Number.isFinite))) return "keys";
    if (isPixelSource(value)) return "source";
    if (typeof value?.var === "string") return "variable";
    return values.isExpression(value) ? "expression" : parameter.type;
  };
  const makers = {
    keys: curveControl,
    source: sourceControl,
    rack: rackControl,
    variable: (context) => variableControl({ ...context, unit: parameter.unit }),
    expression: (context) => textControl(context, values.asText, anyValue),
  };
  return {
    node,
    showFrame,
    update(next) {
      entry = next;
      const wanted = kindOf(entry);
      if (wanted !== kind) {
        kind = wanted;
        control = (makers[kind] ?? controlFor)({
          label,
          parameter,
          describedBy,
          commit,
          time,
          variables,
          objects,
          measured,
        });
        holder.replaceChildren(...control.nodes);
        node.classList.toggle("tall", Boolean(control.isTall));
      }
      control.update(entry);
      showFrame();
      const isSet = entry.value !== undefined,
        { tag: word, words } = values.sourceOf(entry.from);
      node.classList.toggle("set", isSet);
      reset.hidden = !isSet;
      tag.replaceChildren(...(word && !isSet ? [icon(word)] : []));
      tag.title = words;
      hint.textContent = `${parameter.doc} (${rangeWords(parameter)}) Now ${words}.`;
    },
  };
}
