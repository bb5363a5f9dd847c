// Shortcuts: one list, for the keys and for the help.
import { button, element } from "./elements.js";

const isText = (node) =>
  node?.matches?.("textarea, select, input:not([type=checkbox]):not([type=range]):not([type=color])") ?? false;

/** actions: [{keys: ["Ctrl+Z"], group, words, run(event)}]; entries without `run` are handled where they apply. */
export class Shortcuts {
  constructor(actions) {
    this.actions = actions;
    this.dialog = this.build();
    document.body.append(this.dialog);
    document.addEventListener("keydown", (event) => this.onKey(event));
  }

  build() {
    const groups = [...new Set(this.actions.map(({ group }) => group))];
    return element(
      "dialog",
      { class: "help", "aria-label": "Shortcuts" },
      element(
        "div",
        { class: "help-head" },
        element("h2", {}, "Shortcuts"),
        button("Close", () => this.dialog.close()),
      ),
      element(
        "div",
        { class: "groups", tabindex: 0, role: "region", "aria-label": "List of shortcuts" },
        groups.map((group) =>
          element(
            "section",
            {},
            element("h3", {}, group),
            element(
              "dl",
              {},
              this.actions
                .filter((action) => action.group === group)
                .map(({ keys, words }) =>
                  element(
                    "div",
                    {},
                    element(
                      "dt",
                      {},
                      keys.map((key) => element("kbd", {}, key)),
                    ),
                    element("dd", {}, words),
                  ),
                ),
            ),
          ),
        ),
      ),
    );
  }

  open() {
    this.dialog.showModal();
  }

  onKey(event) {
    if (document.querySelector("dialog[open]")) return;
    const inText = isText(event.target);
    const name = [
      event.ctrlKey || event.metaKey ? "Ctrl" : "",
      event.shiftKey && event.key.length > 1 ? "Shift" : "",
      event.key === " " ? "Space" : event.key,
    ]
      .filter(Boolean)
      .join("+");
    const upper =
      event.shiftKey && /^[a-z]$/i.test(event.key)
        ? name.replace(/[a-z]$/i, (key) => `Shift+${key.toUpperCase()}`)
        : name;
    const action = this.actions.find(
      ({ keys, run }) => run && keys.some((key) => key.toLowerCase() === upper.toLowerCase()),
    );
    if (!action) return;
    const isUndo = action.inText === "edited";
    if (inText && !action.inText) return;
    // In a text that is being edited, undo is the browser's.
    if (inText && isUndo && event.target.matches("textarea, .edited")) return;
    if (name === "Space" && event.target.matches("button, input, select, textarea, summary, [role=slider]")) return;
    event.preventDefault();
    action.run(event);
  }

  onKeyUp(key, run) {
    document.addEventListener("keyup", (event) => event.key.toLowerCase() === key && run());
  }
}
