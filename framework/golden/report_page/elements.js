// Elements of the page. Text goes in as text only, never as HTML: names and messages are anyone's.

/** element("p", {class: "x", onclick: f}, "text", child, [children], null) */
function element(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
    else node.setAttribute(key, value === true ? "" : value);
  }
  node.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return node;
}

/** Says something to people who see the page and to those who hear it. */
function tell(words) {
  const place = document.getElementById("notice");
  place.textContent = words;
  clearTimeout(tell.timer);
  tell.timer = setTimeout(() => (place.textContent = ""), 2500);
}

async function copy(text, code, done = "Copied") {
  try {
    await navigator.clipboard.writeText(text);
    tell(done);
  } catch {
    // A page from a file may not write to the clipboard: what is selected can be copied by hand.
    getSelection().selectAllChildren(code);
    tell("Selected: press Ctrl+C");
  }
}

/** A command line with what it does, and a button that copies it. */
function commandLine(label, command) {
  const code = element("code", { tabindex: 0 }, command); // reached by keys, because it can scroll
  const button = element(
    "button",
    { type: "button", onclick: () => copy(command, code), "aria-label": `Copy: ${label}` },
    "Copy",
  );
  return element("div", { class: "command" }, element("span", { class: "label" }, label), code, button);
}

function table(heads, rows, attributes = {}) {
  return element(
    "table",
    attributes,
    element(
      "thead",
      {},
      element(
        "tr",
        {},
        heads.map((head) => element("th", { scope: "col" }, head)),
      ),
    ),
    element(
      "tbody",
      {},
      rows.map((cells) =>
        element(
          "tr",
          {},
          cells.map((cell, i) => (i === 0 ? element("th", { scope: "row" }, cell) : element("td", {}, cell))),
        ),
      ),
    ),
  );
}

function facts(pairs) {
  return element(
    "dl",
    { class: "facts" },
    pairs
      .filter(([, value]) => value !== null && value !== undefined && value !== "")
      .map(([name, value]) => element("div", {}, element("dt", {}, name), element("dd", {}, value))),
  );
}
