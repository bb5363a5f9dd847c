// Elements of the page. Text goes in as text only, never as HTML: names and messages come from files.

const ICONS = {
  undo: "M6 3 2.5 6.5 6 10M3 6.5h6a4 4 0 0 1 0 8H7",
  redo: "m10 3 3.5 3.5L10 10m3-3.5H7a4 4 0 0 0 0 8h2",
  save: "M2.5 2.5h8l3 3v8h-11zM5 2.5v4h5v-4M5 13.5v-4h6v4",
  plus: "M8 3v10M3 8h10",
  remove: "m4 4 8 8m0-8-8 8",
  caret: "m6 4 4 4-4 4",
  grip: "M6 3.5v.01M10 3.5v.01M6 8v.01M10 8v.01M6 12.5v.01M10 12.5v.01",
  reset: "M3 8a5 5 0 1 1 1.6 3.7M3 12V8.5h3.5",
  play: "M4.5 3v10l8-5z",
  pause: "M5 3v10M11 3v10",
  previous: "m10 3-5 5 5 5",
  next: "m6 3 5 5-5 5",
  pick: "M8 1.5v3m0 7v3M1.5 8h3m7 0h3M8 5a3 3 0 1 0 0 6 3 3 0 0 0 0-6",
  theme: "M8 2a6 6 0 1 0 0 12zM8 2a6 6 0 0 1 0 12",
  up: "m4 10 4-4 4 4",
  down: "m4 6 4 4 4-4",
  capture: "M2 5h3l1-1.5h4L11 5h3v8H2zM8 6.5a2.2 2.2 0 1 0 0 4.4 2.2 2.2 0 0 0 0-4.4",
  preset: "M3 4.5h10M3 8h7M3 11.5h4",
  keys: "m8 3 4.5 5L8 13 3.5 8z",
  variable: "m4.5 5 7 6m0-6-7 6",
  export: "M8 2.5v7.5m-3-3 3 3 3-3M2.5 11v2.5h11V11",
  list: "M2.5 4h.01M5 4h8.5M2.5 8h.01M5 8h8.5M2.5 12h.01M5 12h8.5",
  copy: "M5.5 5.5v-3h8v8h-3m-8-5h8v8h-8z",
};

/** element("p", {class: "x", onclick: f}, "text", child, [children], null) */
export function element(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
    else node.setAttribute(key, value === true ? "" : value);
  }
  node.append(...children.flat(2).filter((child) => child !== null && child !== undefined));
  return node;
}

export function icon(name) {
  const space = "http://www.w3.org/2000/svg",
    svg = document.createElementNS(space, "svg"),
    path = document.createElementNS(space, "path");
  for (const [key, value] of Object.entries({ viewBox: "0 0 16 16", class: "icon", "aria-hidden": "true" }))
    svg.setAttribute(key, value);
  path.setAttribute("d", ICONS[name]);
  svg.append(path);
  return svg;
}

/** A button with an icon alone; `label` is its name and, with its shortcut, its tooltip. */
export function iconButton(name, label, onclick, { shortcut, ...more } = {}) {
  return element(
    "button",
    {
      type: "button",
      class: "icon-button",
      "aria-label": label,
      title: shortcut ? `${label} (${shortcut})` : label,
      "aria-keyshortcuts": shortcut?.replace("Ctrl", "Control"),
      onclick,
      ...more,
    },
    icon(name),
  );
}

export function button(words, onclick, more = {}) {
  return element("button", { type: "button", onclick, ...more }, words);
}

export function options(select, entries, chosen) {
  const same =
    select.options.length === entries.length && entries.every(([value], i) => select.options[i].value === value);
  if (!same) select.replaceChildren(...entries.map(([value, words]) => element("option", { value }, words)));
  else
    entries.forEach(
      ([, words], i) => select.options[i].textContent !== words && (select.options[i].textContent = words),
    );
  select.value = chosen;
}

let quiet;
/** Shows a sentence for a while, and has screen readers say it. */
export function notify(words, isError = false) {
  const place = document.getElementById("notice");
  if (place.textContent !== words) place.textContent = words; // the same words are not read out again
  place.classList.toggle("error", isError);
  clearTimeout(quiet);
  quiet = setTimeout(() => (place.textContent = ""), isError ? 9000 : 2500);
}

let serial = 0;
export const freshId = (prefix) => `${prefix}-${++serial}`;
