// A scattering profile: one that is shipped, a file, or the numbers of one of the four types; also by object.
import { element, freshId } from "./elements.js";
import { field } from "./number.js";
import { objectsTable } from "./objects_table.js";
import * as values from "./values.js";

/** As `aftershade list --scattering-profiles` prints them; a test compares. */
const SHIPPED = [
  "apple",
  "chicken1",
  "chicken2",
  "cream",
  "ketchup",
  "marble",
  "potato",
  "skim_milk",
  "skin",
  "skin1",
  "skin2",
  "skin_artist",
  "skin_burley",
  "skin_unreal",
  "whole_milk",
];
const VEC = { count: 3 },
  ONE = { count: 1 };
/** Numbers of each type, and what a new one begins with. docs/params.md describes them. */
const TYPES = {
  burley: {
    fields: { d_mm: VEC, albedo: { ...VEC, min: 0, max: 1 }, mean_free_path_mm: VEC },
    begin: { d_mm: [0.6, 0.12, 0.07] },
  },
  gaussians: { fields: {}, begin: { gaussians: [{ variance_mm2: 0.1, weight: 1 }] } },
  dipole: {
    fields: {
      absorption_per_mm: { ...VEC, min: 1e-5, max: 1000 },
      reduced_scattering_per_mm: { ...VEC, min: 1e-5, max: 10000 },
      ior: { ...ONE, min: 1, max: 3, default: 1.3 },
    },
    begin: { absorption_per_mm: [0.01, 0.05, 0.1], reduced_scattering_per_mm: [1, 1, 1] },
  },
  artist: {
    fields: {
      falloff: { ...VEC, min: 0, max: 1, default: [1, 0.37, 0.3] },
      strength: { ...VEC, min: 0.001, max: 1, default: [0.48, 0.41, 0.28] },
      width_mm: { ...ONE, min: 1e-6, max: 1e6, default: 1 },
    },
    begin: { width_mm: 1 },
  },
};
const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);
const kindOf = (profile) => (isObject(profile) ? profile.type : SHIPPED.includes(profile) ? profile : "file");

export function profileControl({ label, describedBy, commit, objects }) {
  let value = "",
    shownKind = null,
    numbers = [];
  const isByObject = () => isObject(value) && ("rows" in value || "default" in value);
  const profile = () => (isByObject() ? (value.default ?? "skin") : value);
  const send = (next) => commit(isByObject() ? { ...value, default: next } : next);

  const choice = element(
    "select",
    { class: "wide", "aria-label": `Profile of ${label}`, "aria-describedby": describedBy },
    element(
      "optgroup",
      { label: "Shipped" },
      SHIPPED.map((name) => element("option", { value: name }, name)),
    ),
    element(
      "optgroup",
      { label: "Own numbers" },
      Object.keys(TYPES).map((name) => element("option", { value: name }, name)),
    ),
    element("option", { value: "file" }, "file"),
  );
  choice.addEventListener("change", () => {
    const kind = choice.value;
    if (kind !== "file") return send(kind in TYPES ? { type: kind, ...TYPES[kind].begin } : kind);
    build("file");
    numbers[0].node.focus();
  });
  const parts = element("div", { class: "wide profile" });
  const line = (name, nodes) => element("div", { class: "profile-line" }, element("span", {}, name), nodes);

  function numberFields(key, declared) {
    const list = () => {
      const now = profile()[key] ?? declared.default;
      return declared.count === 1 ? [now] : Array.isArray(now) ? now : [now, now, now];
    };
    const labels = declared.count === 1 ? [""] : [", red", ", green", ", blue"];
    const fields = labels.map((suffix, i) =>
      field({
        label: `${label}, ${key.replaceAll("_", " ")}${suffix}`,
        inputmode: "decimal",
        parse: (text) => values.typedNumber(text, { type: "float", ...declared }),
        commit: (number) => {
          const all = list().map((old, at) => (at === i ? number : old));
          return send({ ...profile(), [key]: declared.count === 1 ? number : all });
        },
      }),
    );
    return {
      node: fields[0].node,
      row: line(
        key.replaceAll("_", " "),
        fields.map(({ node }) => node),
      ),
      update: () => list().forEach((number, i) => fields[i].show(values.short(number, 6))),
    };
  }
  function textField(name, toText, parse) {
    const { node, show } = field({ label: `${label}, ${name}`, className: "field text", parse, commit: send });
    return { node, row: line(name, node), update: () => show(toText(profile())) };
  }
  /** The fields of a kind; of Burley's, those of the way in which it is written. */
  function build(kind) {
    const now = profile(),
      isKind = isObject(now) && now.type === kind;
    shownKind = JSON.stringify([kind, isKind && "albedo" in now]);
    if (kind === "file")
      numbers = [
        textField(
          "file",
          (one) => (isObject(one) || SHIPPED.includes(one) ? "" : String(one)),
          (text) => (text.trim() ? { value: text.trim() } : { error: "a path that ends in .json" }),
        ),
      ];
    else if (kind === "gaussians")
      numbers = [
        textField(
          "gaussians",
          (one) => JSON.stringify(one.gaussians),
          (text) => {
            try {
              return { value: { ...profile(), gaussians: JSON.parse(text) } };
            } catch (error) {
              return { error: error.message };
            }
          },
        ),
      ];
    else
      numbers = Object.entries(TYPES[kind]?.fields ?? {})
        .filter(([key, declared]) => key in now || declared.default !== undefined)
        .map(([key, declared]) => numberFields(key, declared));
    parts.replaceChildren(...numbers.map(({ row }) => row));
    choice.value = kind;
  }

  const listId = freshId("profiles");
  const table = objectsTable({
    label,
    columns: { profile: { type: "profile", begin: "skin", default: "skin" } },
    hasOthers: false,
    onRows: (rows) => commit(rows.length ? { ...(isByObject() ? value : { default: value }), rows } : profile()),
    objects,
    listId,
  });
  const shipped = element(
    "datalist",
    { id: listId },
    SHIPPED.map((name) => element("option", { value: name })),
  );
  return {
    nodes: [choice, parts, element("div", { class: "wide" }, table.node, shipped)],
    isTall: true,
    update(entry) {
      const wasFile = choice.value === "file" && shownKind?.startsWith('["file"');
      const before = JSON.stringify(value);
      value = entry.value ?? entry.effective ?? "";
      const now = profile(),
        kind = kindOf(now);
      // "file" without a path yet stays open until the value changes.
      if (!(wasFile && JSON.stringify(value) === before)) {
        const wanted = JSON.stringify([kind, isObject(now) && "albedo" in now]);
        if (wanted !== shownKind) build(kind);
      }
      for (const one of numbers) one.update();
      table.update(isByObject() ? (value.rows ?? []) : []);
    },
  };
}
