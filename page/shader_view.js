// The shaders of the effects of the look's steps, beside the picture: written on save, with GLSL's faults at their lines.
import { get } from "./api.js";
import { CodeArea } from "./code_area.js";
import { button, element, notify, options } from "./elements.js";
import { glslWords } from "./glsl_words.js";
import { faultList } from "./text_view.js";

/** "effects/tint/tint.frag:6:17: error: 'parm' undeclared   [pass tint, llvmpipe ...]" */
const FAULT = /^(.+?):(\d+)(?::(\d+))?: (?:error|warning): (.*)$/;

/** [{path, line, column, message}] of the program's message; a message without a line has none. */
export const shaderFaults = (message) =>
  message.split("\n").flatMap((one) => {
    const found = FAULT.exec(one.trim());
    return found
      ? [{ path: found[1], line: Number(found[2]), column: Number(found[3] ?? 1) || 1, message: found[4] }]
      : [];
  });

export class ShaderView {
  /** What is on disk, by effect: {folder, why_not, files: {name: text}}. */
  #disk = new Map();
  /** What is typed and not saved, by effect and file: {text, before}; `before` is the file it was typed over. */
  #drafts = new Map();
  #faults = [];

  constructor(store) {
    this.store = store;
    this.effectSelect = element("select", { "aria-label": "Effect" });
    this.effectSelect.addEventListener("change", () => this.show(this.effectSelect.value));
    this.fileSelect = element("select", { "aria-label": "File" });
    this.fileSelect.addEventListener("change", () => this.show(this.effect, this.fileSelect.value));
    this.saveButton = button("Save shader", () => this.save(), { title: "Save the shader (Ctrl+S in its text)" });
    this.revertButton = button("Revert", () => this.revert(), { title: "Show the shader as it is on disk again" });
    this.note = element("p", { class: "hint shown", id: "shader-help" });
    this.list = element("div", { class: "shader-faults", role: "alert", hidden: true });
    this.code = new CodeArea({
      label: "The shader as GLSL",
      describedBy: "shader-help",
      language: "glsl",
      complete: (text, at) => glslWords(text, at, store.effects.get(this.effect)),
    });
    this.code.area.addEventListener("input", () => {
      const isAsOnDisk = this.code.value === this.stored;
      if (isAsOnDisk) this.#drafts.delete(this.key);
      else
        this.#drafts.set(this.key, {
          text: this.code.value,
          before: this.#drafts.get(this.key)?.before ?? this.stored,
        });
      this.mark();
    });
    this.node = element(
      "div",
      { class: "text-view" },
      element("div", { class: "shader-head" }, this.effectSelect, this.fileSelect, this.revertButton, this.saveButton),
      this.list,
      this.code.node,
      this.note,
      this.#newForm(),
    );
  }

  #newForm() {
    this.newName = element("input", {
      type: "text",
      "aria-label": "Name of a new effect",
      placeholder: "name_of_a_new_effect",
      maxlength: 64,
      autocomplete: "off",
      spellcheck: "false",
    });
    this.newFolder = element("select", { "aria-label": "Folder of a new effect" });
    this.newForm = element(
      "form",
      { class: "shader-head new-effect", hidden: true },
      this.newName,
      this.newFolder,
      element("button", { type: "submit", title: "Make an effect's folder and add it to the look" }, "New effect"),
    );
    this.newForm.addEventListener("submit", (event) => {
      event.preventDefault();
      this.make();
    });
    return this.newForm;
  }

  /** Makes an effect from the templates, adds it as the last step and shows its shader. */
  async make() {
    const effect = this.newName.value.trim();
    if (!(await this.store.newEffect({ folder: this.newFolder.value, effect }))) return this.newName.focus();
    this.newName.value = "";
    const isAdded = await this.store.edit([{ op: "add", at: this.store.lastPlace, effect }]);
    if (!isAdded) return;
    notify(`Made ${effect}`);
    await this.show(effect);
    this.code.area.focus();
  }

  get key() {
    return `${this.effect}/${this.file}`;
  }
  get stored() {
    return this.#disk.get(this.effect)?.files[this.file];
  }
  get isEdited() {
    return this.#drafts.size > 0;
  }

  /** The look has changed, or the effects on disk. */
  async update() {
    const { steps, effects_revision, effect_folders, read_only } = this.store.state;
    this.newForm.hidden = read_only || effect_folders.length === 0;
    this.newFolder.hidden = effect_folders.length < 2;
    options(
      this.newFolder,
      effect_folders.map((folder) => [folder, folder]),
      this.newFolder.value || effect_folders[0],
    );
    if (effects_revision !== this.revision) this.#disk.clear();
    this.revision = effects_revision;
    const effects = [...new Set(steps.map(({ effect }) => effect))].filter((id) => this.store.effects.has(id));
    options(
      this.effectSelect,
      effects.map((id) => [id, id]),
      this.effect,
    );
    this.effectSelect.disabled = effects.length === 0;
    if (!effects.includes(this.effect)) this.effect = effects[0];
    await this.show(this.effect, this.file);
  }

  async show(effect, file) {
    this.effect = effect;
    this.effectSelect.value = effect;
    try {
      if (effect && !this.#disk.has(effect)) this.#disk.set(effect, await get("/api/shaders", { effect }));
    } catch (error) {
      return notify(error.message, true);
    }
    if (effect !== this.effect) return; // another was chosen meanwhile
    const { files = {}, why_not = "The look has no step with an effect." } = this.#disk.get(effect) ?? {},
      names = Object.keys(files);
    this.file = names.includes(file) ? file : names[0];
    options(
      this.fileSelect,
      names.map((name) => [name, name]),
      this.file,
    );
    this.fileSelect.disabled = names.length === 0;
    this.code.area.readOnly = why_not !== "" || !this.file;
    this.note.textContent = why_not || "Ctrl+S writes the file and draws the picture with it. Tab leaves the text.";
    this.code.value = this.#drafts.get(this.key)?.text ?? this.stored ?? "";
    this.mark();
  }

  mark() {
    const isEdited = this.#drafts.has(this.key);
    this.saveButton.disabled = this.revertButton.disabled = !isEdited;
    const own = ({ path }) => path.endsWith(`${this.effect}/${this.file}`);
    this.code.number(this.#faults.filter(own).map(({ line }) => line));
  }

  async save() {
    if (!this.#drafts.has(this.key)) return;
    const { effect, file, key } = this,
      { text, before } = this.#drafts.get(key);
    if (!(await this.store.saveShader({ effect, file, before, text }))) return;
    // What was typed since then stays a draft.
    const draft = this.#drafts.get(key);
    if (draft?.text === text) this.#drafts.delete(key);
    else if (draft) draft.before = text;
    notify(`Saved ${file}`);
    this.mark();
  }

  revert() {
    this.#drafts.delete(this.key);
    this.code.value = this.stored ?? "";
    this.mark();
    this.code.area.focus();
  }

  /** `message`: of a picture that could not be drawn; "" once one could. */
  setFault(message) {
    this.#faults = shaderFaults(message);
    this.list.hidden = this.#faults.length === 0;
    this.list.replaceChildren(
      element("p", { class: "count" }, "The picture is from the last text without faults"),
      faultList(
        this.#faults.map((fault) => ({ ...fault, place: `${fault.path.split("/").at(-1)}:${fault.line}` })),
        (fault) => this.goTo(fault),
      ),
    );
    this.mark();
  }

  async goTo({ path, line, column }) {
    const [effect, file] = path.split("/").slice(-2);
    if (this.effect !== effect || this.file !== file) await this.show(effect, file);
    if (this.effect === effect && this.file === file) this.code.goTo(line, column);
  }
}
