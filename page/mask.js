// Where a step applies: a role of the capture, objects, or a picture file; and whether everywhere else instead.
import { element, iconButton, options } from "./elements.js";
import { field } from "./number.js";
import { objectsFrom, objectsText } from "./values.js";

const KINDS = ["role", "object", "file"];
const WORDS = { "": "none", role: "role", object: "objects", file: "file" };

/**
 * {node, update(mask, roles)}; `commit(mask)` sets it, null takes it out. `objects`: {names, pick(node, take),
 * choose(take)} of the frame's objects.
 */
export function maskRow({ commit, objects: frame }) {
  let mask = null,
    kind = "";
  const choice = element("select", { "aria-label": "Mask by" });
  options(
    choice,
    ["", ...KINDS].map((one) => [one, WORDS[one]]),
    "",
  );
  const invert = element("input", { type: "checkbox", "aria-label": "Invert the mask" });
  const role = element("select", { "aria-label": "Mask's role" });
  const send = (value) => {
    const { invert: isInverted } = mask ?? {};
    return commit({ [kind]: value, ...(isInverted === undefined ? {} : { invert: isInverted }) });
  };
  role.addEventListener("change", () => send(role.value));
  const objects = field({
    label: "Mask's objects",
    className: "field text",
    parse: (text) => {
      const list = objectsFrom(text);
      return list.length ? { value: list.length === 1 ? list[0] : list } : { error: "examples: 2, 4-7, Wheel" };
    },
    commit: send,
  });
  const file = field({
    label: "Mask's file",
    className: "field text",
    parse: (text) => (text.trim() ? { value: text.trim() } : { error: "a path from the look's folder" }),
    commit: send,
  });
  const picker = iconButton("pick", "Pick the mask's object in the picture", () => frame.pick(picker, send), {
    class: "icon-button picker",
    "aria-pressed": "false",
  });
  const chooser = iconButton("list", "Choose objects of the mask from a list", () =>
    frame.choose((key) => {
      const rest = mask?.object === undefined ? [] : [mask.object].flat();
      send(rest.length ? [...rest.filter((one) => one !== key), key] : key);
    }),
  );
  const objectPart = element("span", { class: "vector" }, objects.node, chooser, picker),
    inverted = element("label", { class: "invert" }, invert, "invert");
  choice.addEventListener("change", () => {
    kind = choice.value;
    if (!kind) return mask && commit(null);
    show();
    if (kind === "role" && role.value) send(role.value);
    else if (kind !== "role") (kind === "object" ? objects : file).node.focus();
  });
  invert.addEventListener("change", () => {
    const { invert: _, ...rest } = mask;
    commit(invert.checked ? { ...rest, invert: true } : rest);
  });
  function show() {
    choice.value = kind;
    role.hidden = kind !== "role";
    objectPart.hidden = kind !== "object";
    file.node.hidden = kind !== "file";
    inverted.hidden = !mask || !(kind in mask);
  }
  const error = element("p", { class: "refusal", role: "alert" });
  const node = element(
    "div",
    { class: "row" },
    element("span", { class: "label" }, "mask"),
    element(
      "div",
      { class: "controls" },
      element("span", { class: "wide mask" }, choice, role, objectPart, file.node, inverted),
    ),
    element("span", { class: "key-place" }),
    element("span", { class: "source" }),
    error,
    element("p", { class: "hint" }, "Where the step applies. Objects: ids, ranges of ids, names, as in 2, 4-7, Wheel."),
  );
  node.addEventListener("refused", ({ detail }) => (error.textContent = detail ?? ""));
  return {
    node,
    update(next, roles) {
      const isChanged = JSON.stringify(next ?? null) !== JSON.stringify(mask);
      mask = next ?? null;
      if (isChanged) kind = KINDS.find((one) => mask && one in mask) ?? "";
      const names = roles.filter(({ channels }) => channels === 1).map(({ name }) => name);
      if (mask?.role && !names.includes(mask.role)) names.push(mask.role);
      options(
        role,
        names.map((name) => [name, name]),
        mask?.role ?? names[0] ?? "",
      );
      objects.show(mask?.object === undefined ? "" : objectsText([mask.object].flat(), frame.names.words));
      file.show(mask?.file ?? "");
      invert.checked = mask?.invert === true;
      show();
    },
  };
}
