// The authoring page: a look made by eye. The program that serves it holds the look and draws the pictures.
import { AddDialog } from "./add_dialog.js";
import { get, token } from "./api.js";
import { Costs, Histogram, Probe } from "./dock.js";
import { addDivider } from "./divider.js";
import { button, element, icon, iconButton, notify } from "./elements.js";
import { acceptDrops } from "./drop.js";
import { ExportDialog } from "./export.js";
import { Gallery } from "./gallery.js";
import { Shortcuts } from "./keys.js";
import { keyOf, objectAt, ObjectDialog, ObjectNames } from "./objects.js";
import { SaveDialog } from "./save_dialog.js";
import { ShaderView } from "./shader_view.js";
import { sourceOf } from "./source.js";
import { nameOf, StepList } from "./steps.js";
import { Store } from "./store.js";
import { Faults, TextView } from "./text_view.js";
import { short } from "./values.js";
import { Thumbnails } from "./thumbnails.js";
import { Viewer } from "./viewer.js";
import { Waveform } from "./waveform.js";

const store = new Store();
const at = (id) => document.getElementById(id);

// ---- parts ----

const viewer = new Viewer(store, at("viewer"));
const probe = new Probe(),
  histogram = new Histogram(),
  waveform = new Waveform(),
  costs = new Costs();
at("dock").append(probe.node, histogram.node, waveform.node, costs.node);

const thumbnails = new Thumbnails(store, viewer);
const dialog = new AddDialog(store, thumbnails);
const openAdd = () => dialog.open(store.lastPlace);

const names = new ObjectNames(store, viewer),
  objectDialog = new ObjectDialog(names);
const objects = {
  names,
  pick: (node, take) =>
    viewer.pick(node, (pixel) => {
      const found = objectAt(pixel) ?? pixel.objects[0];
      if (!found) return notify("The capture has no objects at this pixel", true);
      take(keyOf(found));
    }),
  choose: (take) => objectDialog.open(take),
};

/**
 * What the frame can give a parameter: the depth of an object or a point for a focus, its light for an exposure, an object
 * for a list of such. null for other parameters.
 */
function pickFor(parameter) {
  if (parameter.type === "objects") return { click: (node, take) => objects.pick(node, (key) => take([key])) };
  const isFocus = parameter.from === "camera.focus_distance",
    isExposure = parameter.unit === "ev" && parameter.type === "float" && parameter.bind !== "define";
  if (!isFocus && !isExposure) return null;
  const fromPixel = (pixel, take) => {
    const found = pixel.isPoint ? null : objectAt(pixel);
    if (found) return take(sourceOf(parameter, keyOf(found)));
    const { width, height } = store.state.capture,
      uv = [(pixel.x + 0.5) / width, (pixel.y + 0.5) / height].map((place) => Number(place.toFixed(4)));
    if (isExposure) return take({ from: "luminance", uv });
    const depth = pixel.roles.find(({ name }) => name === "depth")?.values[0];
    if (!Number.isFinite(depth)) return notify("The capture has no depth at this pixel", true);
    take(Number(short(depth)));
  };
  return {
    click: (node, take) => viewer.pick(node, (pixel) => fromPixel(pixel, take)),
    choose: (take) => objects.choose((key) => take(sourceOf(parameter, key))),
  };
}
const exporting = new ExportDialog(store, viewer);
const gallery = new Gallery(store, viewer, thumbnails, () => list.focus(0));
const list = new StepList(store, { add: openAdd, pickFor, objects, time: viewer, gallery });
acceptDrops(store);
viewer.addEventListener("frame", () => list.showFrame());
dialog.node.addEventListener("close", () => list.update()); // its pictures stopped those of the gallery
dialog.node.addEventListener("added", async ({ detail }) => {
  if (!(await detail.done)) return;
  list.cards[detail.at]?.toggle(true);
  list.focus(detail.at);
  notify(`${list.cards[detail.at]?.title.textContent} added as step ${detail.at + 1}`);
});
const text = new TextView(store, names);
exporting.textOfLook = () => (text.isTyped ? text.area.value : store.state.text);
const faults = new Faults(store, (line, column) => {
  showPanel("text");
  text.goTo(line, column);
});

const shaders = new ShaderView(store);
viewer.addEventListener("fail", ({ detail }) => {
  shaders.setFault(detail.message);
  list.showFault();
});

const panels = { steps: list.node, text: text.node, shaders: shaders.node },
  panelNames = { steps: "Steps", text: "Text", shaders: "Shaders" };
const tabs = Object.keys(panels).map((name) =>
  button(panelNames[name], () => showPanel(name), {
    role: "tab",
    id: `tab-${name}`,
    "aria-controls": `panel-${name}`,
    title: "Steps, text or shaders (T)",
  }),
);
for (const [name, node] of Object.entries(panels)) {
  node.id = `panel-${name}`;
  node.setAttribute("role", "tabpanel");
  node.setAttribute("aria-labelledby", `tab-${name}`);
}
function showPanel(name) {
  for (const [one, node] of Object.entries(panels)) node.hidden = one !== name;
  tabs.forEach((tab) => {
    const isShown = tab.id === `tab-${name}`;
    tab.setAttribute("aria-selected", String(isShown));
    tab.tabIndex = isShown ? 0 : -1;
  });
  if (name === "text" && store.state) text.update();
  if (name === "shaders" && store.state) shaders.update();
}
const tablist = element("div", { class: "tabs", role: "tablist", "aria-label": "Look as" }, tabs);
tablist.addEventListener("keydown", (event) => {
  if (event.key !== "ArrowLeft" && event.key !== "ArrowRight") return;
  const by = event.key === "ArrowLeft" ? -1 : 1,
    other = tabs.at((tabs.indexOf(event.target) + by) % tabs.length);
  other.click();
  other.focus();
});
const EXPLAIN = "Point at a value to read what it does, its limits and where it comes from.";
const help = element("p", { class: "explain", "aria-hidden": "true" }, EXPLAIN);
at("look").append(tablist, faults.node, list.node, text.node, shaders.node, help);
showPanel("steps");
// What the row with the focus is for; where none has it, the row under the pointer.
const rowOf = (node) => (at("look").contains(node) ? node.closest(".row") : null);
let explained = null;
const explain = () => (help.textContent = explained?.querySelector(".hint")?.textContent ?? EXPLAIN);
for (const name of ["focusin", "focusout", "pointerover", "pointerleave"])
  at("look").addEventListener(name, ({ type, target }) => {
    explained = (type === "focusin" && rowOf(target)) || rowOf(document.activeElement) || rowOf(target);
    explain();
  });
addDivider(at("work"), at("look"));

// ---- the bar ----

const THEMES = ["system", "dark", "light"];
function setTheme(theme) {
  if (theme === "system") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = theme;
  try {
    localStorage.setItem("aftershade.theme", theme);
  } catch {
    // Private windows may refuse; the theme then lasts as long as the page.
  }
  themeButton.title = `Colours: ${theme} (Shift+D)`;
  themeButton.setAttribute("aria-label", `Colours: ${theme}`);
  histogram.draw();
  waveform.draw();
}
function nextTheme() {
  const now = document.documentElement.dataset.theme ?? "system";
  setTheme(THEMES[(THEMES.indexOf(now) + 1) % THEMES.length]);
}
async function copyCommand() {
  try {
    const { command } = await get("/api/command");
    await navigator.clipboard.writeText(command);
    notify(`Copied: ${command}`);
  } catch (error) {
    notify(error.message, true);
  }
}
function nextPanel() {
  const names = Object.keys(panels);
  showPanel(names[(names.findIndex((name) => !panels[name].hidden) + 1) % names.length]);
}
async function save() {
  if (shaders.node.contains(document.activeElement)) return shaders.save();
  if (store.state.read_only) return notify("The program was started with --read-only", true);
  if (store.hasFaults && !(await saving.confirm())) return;
  const isSaved = store.state.look.has_name ? await store.save() : await saving.open();
  if (isSaved) notify(`Saved ${store.state.look.name}`);
}
const saving = new SaveDialog(store);
const undoButton = iconButton("undo", "Undo", () => store.undo(), { shortcut: "Ctrl+Z" }),
  redoButton = iconButton("redo", "Redo", () => store.redo(), { shortcut: "Ctrl+Shift+Z" }),
  saveButton = button([icon("save"), "Save"], save, { title: "Save (Ctrl+S)", class: "save" }),
  themeButton = iconButton("theme", "Colours", nextTheme),
  lookName = element("span", { class: "file" }),
  mark = element("span", { class: "mark" }),
  captureName = element("span", { class: "capture" });
at("bar").append(
  element("h1", {}, "Aftershade"),
  element("span", { class: "names" }, lookName, mark, captureName),
  element("span", { class: "space" }),
  undoButton,
  redoButton,
  button([icon("copy"), "Command"], copyCommand, {
    title: "Copy the command that draws these pictures (Ctrl+Shift+C)",
    class: "command",
  }),
  button([icon("export"), "Export"], () => exporting.open(), { title: "Export (X)", class: "export-button" }),
  themeButton,
  button("?", () => shortcuts.open(), { class: "icon-button", title: "Shortcuts (?)", "aria-label": "Shortcuts" }),
  saveButton,
);

// ---- shortcuts ----

const beforeOnOff = () => viewer.setOther(viewer.other ? "" : "before");
const shortcuts = new Shortcuts([
  { group: "Look", keys: ["Ctrl+S"], words: "Save; in a shader's text: the shader", run: save, inText: true },
  { group: "Look", keys: ["Ctrl+Z"], words: "Undo", run: () => store.undo(), inText: "edited" },
  { group: "Look", keys: ["Ctrl+Shift+Z", "Ctrl+Y"], words: "Redo", run: () => store.redo(), inText: "edited" },
  { group: "Look", keys: ["T"], words: "Steps, text or shaders", run: nextPanel },
  { group: "Look", keys: ["Ctrl+Space"], words: "In a text: list what fits" },
  { group: "Look", keys: ["X"], words: "Export images, a video, a still, a contact sheet or the look", run: () => exporting.open() },
  { group: "Look", keys: ["Ctrl+Shift+C"], words: "Copy the command", run: copyCommand, inText: true },
  { group: "Steps", keys: ["A"], words: "Add a step", run: openAdd },
  { group: "Steps", keys: ["S"], words: "Go to the steps", run: () => (showPanel("steps"), list.focus(0)) },
  { group: "Steps", keys: ["↑", "↓"], words: "Go to the step above or below" },
  { group: "Steps", keys: ["Enter"], words: "Open or close the step" },
  { group: "Steps", keys: ["Alt+↑", "Alt+↓"], words: "Move the step" },
  { group: "Steps", keys: ["E"], words: "Enable or disable the step" },
  { group: "Steps", keys: ["Delete"], words: "Remove the step" },
  { group: "Values", keys: ["←", "→"], words: "Move the slider by a hundredth of its range" },
  { group: "Values", keys: ["Page Up", "Page Down"], words: "Move the slider by a tenth of its range" },
  { group: "Values", keys: ["↑", "↓"], words: "Change the number by a hundredth of the range; with Shift by a tenth" },
  { group: "Values", keys: ["Enter"], words: "Apply the typed value; it may have a unit or be a sum: 85 mm, 6+0.4" },
  { group: "Values", keys: ["Escape"], words: "Undo typing" },
  { group: "Curves", keys: ["←", "→"], words: "Move the key by a frame; with Shift by 10 frames" },
  { group: "Curves", keys: ["↑", "↓"], words: "Move the key by a hundredth of the slider's range; with Shift by a tenth" },
  { group: "Curves", keys: ["Enter"], words: "Go to the key's frame" },
  { group: "Curves", keys: ["Delete"], words: "Remove the key" },
  { group: "Curves", keys: ["↑", "↓", "←", "→"], words: "Move the handle by 5 %; with Shift by 20 %" },
  { group: "Picture", keys: ["P"], words: "Go to the picture", run: () => viewer.canvas.focus() },
  { group: "Picture", keys: ["↑", "↓", "←", "→"], words: "Move the probe by 1 px; with Shift 10 px" },
  { group: "Picture", keys: ["Ctrl+arrows"], words: "Pan" },
  { group: "Picture", keys: ["+", "="], words: "Zoom in", run: () => viewer.picture.zoomBy(1) },
  { group: "Picture", keys: ["-"], words: "Zoom out", run: () => viewer.picture.zoomBy(-1) },
  { group: "Picture", keys: ["0"], words: "Fit the picture", run: () => viewer.picture.fit() },
  { group: "Picture", keys: ["1"], words: "Zoom to 100 %", run: () => viewer.picture.zoomTo(1) },
  { group: "Picture", keys: ["]"], words: "Brighter by 1/2 EV", run: () => viewer.setExposure(viewer.exposure + 0.5) },
  { group: "Picture", keys: ["["], words: "Darker by 1/2 EV", run: () => viewer.setExposure(viewer.exposure - 0.5) },
  { group: "Compare", keys: ["V"], words: "Next view", run: () => viewer.nextView(1) },
  { group: "Compare", keys: ["Shift+V"], words: "Previous view", run: () => viewer.nextView(-1) },
  { group: "Compare", keys: ["W"], words: "Switch the wipe against the picture before all steps", run: beforeOnOff },
  {
    group: "Compare",
    keys: ["B"],
    words: "Show the picture to compare with, while held",
    run: () => viewer.other && viewer.swap(true),
  },
  { group: "Compare", keys: ["K"], words: "Keep this picture to compare with", run: () => viewer.keep() },
  { group: "Frames", keys: ["Space"], words: "Play or pause", run: () => viewer.play() },
  { group: "Frames", keys: [","], words: "Previous frame", run: () => viewer.stepFrame(-1) },
  { group: "Frames", keys: ["."], words: "Next frame", run: () => viewer.stepFrame(1) },
  { group: "Page", keys: ["?"], words: "Show this list", run: () => shortcuts.open() },
  { group: "Page", keys: ["Shift+D"], words: "Choose the colours: system, dark, light", run: nextTheme },
]);
shortcuts.onKeyUp("b", () => viewer.swap(false));
addEventListener("beforeunload", (event) => {
  if (store.state && (!store.isSaved || shaders.isEdited || text.isTyped)) event.preventDefault();
});

// ---- what changes ----

store.addEventListener("change", () => {
  const { look, capture, can_undo, can_redo, read_only } = store.state,
    isChanged = !store.isSaved;
  lookName.textContent = look.has_name ? look.name : "untitled";
  lookName.title = look.path;
  captureName.textContent = `${capture.width} × ${capture.height}`;
  captureName.title = capture.path;
  const ofFile = look.is_gone ? "file is gone" : isChanged ? "unsaved" : look.has_file ? "" : "new";
  mark.textContent = read_only ? "read-only" : ofFile;
  mark.classList.toggle("changed", isChanged);
  document.title = `${isChanged ? "• " : ""}${lookName.textContent} – Aftershade`;
  undoButton.disabled = !can_undo;
  redoButton.disabled = !can_redo;
  saveButton.disabled = read_only || (!isChanged && look.has_file);
  faults.update();
  viewer.update(); // first: it has the frame that the steps show
  list.update();
  explain();
  if (!text.node.hidden) text.update();
  if (!shaders.node.hidden) shaders.update();
});
store.addEventListener("fail", ({ detail }) => notify(detail.message, true));
let measuring;
viewer.addEventListener("picture", ({ detail }) => {
  const fault = detail.times?.fault;
  list.showFault(fault);
  clearTimeout(measuring);
  shaders.setFault("");
  viewer.setMeasured(detail.times);
  list.showFrame();
  if (!fault) costs.show(detail.times, detail.isCoarse, new Set(list.cards.map(({ step }) => nameOf(step))));
  if (detail.isCoarse) return;
  if (!fault) list.showCosts([...costs.known.values()]);
  if (viewer.isPlaying) return;
  // After a pause: the next picture of a drag does not wait for them.
  measuring = setTimeout(() => {
    histogram.load(viewer.frame);
    const isFinal = viewer.view === "final" && viewer.exposure === 0;
    waveform.load({
      revision: store.state.revision,
      frame: viewer.frame,
      shown: isFinal ? detail.bitmap : null,
    });
    probe.again(viewer.frame);
    if (!fault) costs.truths.load(viewer.frame, store.state.capture.truths[viewer.frame] ?? []);
  }, 150);
});
viewer.addEventListener("probe", ({ detail }) => probe.show(detail, viewer.frame));
addEventListener("focus", () => store.state && store.isSaved && store.refresh());

// As `run --watch`, for a look and effects that are edited in another program.
const FOLLOW_MS = 500;
setInterval(() => store.state?.capture && !document.hidden && store.followFiles(), FOLLOW_MS);

try {
  setTheme(localStorage.getItem("aftershade.theme") ?? "system");
} catch {
  setTheme("system");
}
if (!token) notify("The address has no token: open the one that `aftershade serve` printed", true);
else store.load().catch((error) => notify(error.message, true));

/** For scripts in the browser's console, and for tests. */
window.aftershade = { store, viewer, settled: () => viewer.pictures.settled() };
