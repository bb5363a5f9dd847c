// The whole page: summary, filter, cases with failures first, environment, keys.

const KEYS = [
  ["j, k", "next, previous image"],
  ["o", "open or close the case of the image"],
  ["/", "search"],
  ["?", "show these keys"],
  ["l", "light, dark, or as the system"],
  ["c", "copy the command that approves the case"],
  ["y, n", "approve, reject the case"],
  ["g", "approve all undecided cases of the same cause"],
  ["u", "undo the last decision"],
  ["a r t d h w", "show all, reference, test, difference, FLIP heat map, wipe"],
  ["Space", "swap reference and test"],
  [", .", "move the wipe"],
  ["[ ]", "exposure, half a stop"],
  ["\\", "reset the exposure"],
  ["{ }", "change the scale of the difference"],
  ["+ \u2212 0 1", "zoom in, out, whole picture, 1:1"],
  ["x", "go to the largest difference"],
  ["b", "show or hide a frame around failing pixels"],
  ["m", "show or hide areas that are left out or have limits of their own"],
  ["arrows, drag", "move the picture (click it first)"],
  ["Ctrl + wheel", "zoom; the wheel alone once the picture was clicked"],
];

/** The folder of the suite with the one above it: "tests/golden". */
const suiteName = (report) => report.document.split("/").slice(-3, -1).join("/");

const KEPT = 8; // viewers that keep their pixels

/** Viewers are read when they come near the window, and one of them is who keys are for. */
class Viewers {
  constructor() {
    this.all = new Map();
    this.current = null;
    this.near = new IntersectionObserver(
      (entries) => {
        for (const { isIntersecting, target } of entries) this.move(this.all.get(target), isIntersecting);
      },
      { rootMargin: "600px" },
    );
    this.far = []; // left last at the end; pixels of hundreds of pictures do not fit into memory
  }
  move(viewer, isNear) {
    this.far = this.far.filter((other) => other !== viewer);
    if (isNear) {
      if (!viewer.isReady) viewer.load();
    } else if (viewer.isReady) {
      this.far.push(viewer);
      while (this.far.length > KEPT) this.far.shift().release();
    }
  }
  add(viewer) {
    this.all.set(viewer.node, viewer);
    this.near.observe(viewer.node);
    for (const event of ["pointerenter", "focusin"]) viewer.node.addEventListener(event, () => this.choose(viewer));
  }
  choose(viewer) {
    this.current?.node.classList.remove("current");
    this.current = viewer;
    viewer.node.classList.add("current");
  }
  visible() {
    const isOpen = (card) => card.open && !card.hidden; // a closed one's content has an offsetParent all the same
    const nodes = [...document.querySelectorAll(".viewer")].filter((node) => isOpen(node.closest(".case")));
    return nodes.map((node) => this.all.get(node));
  }
  step(by) {
    const visible = this.visible();
    if (visible.length === 0) return;
    const isBefore = (viewer) =>
      this.current && this.current.node.compareDocumentPosition(viewer.node) & Node.DOCUMENT_POSITION_PRECEDING;
    // Where the current one is not to be seen, because its case has been closed, the next is the first after it.
    const steps = by > 0 && !visible.includes(this.current) ? 0 : by;
    const next = Math.min(Math.max(visible.filter(isBefore).length + steps, 0), visible.length - 1);
    this.choose(visible[next]);
    visible[next].canvas.focus({ preventScroll: true });
    visible[next].node.closest(".image").scrollIntoView({ block: "start" });
  }
}

class Page {
  constructor(report) {
    this.report = report;
    this.viewers = new Viewers();
    this.kinds = new Set(KINDS);
    document.title = `${report.verdict === "same" ? "\u2713" : "\u2717"} ${suiteName(report)}`;
    this.setTheme(this.savedTheme());
    this.buildHead();
    this.buildCases();
    this.buildFoot();
    if (report.cases.some(isReviewable)) {
      this.review = new Review(report, this);
      this.review.start();
    }
    document.addEventListener("keydown", (event) => this.key(event));
    addEventListener("hashchange", () => this.openLinked());
    this.openLinked();
  }

  // ---- summary ----

  buildHead() {
    const { report } = this,
      { counts } = report;
    const numbers = { failed: counts.failed, warned: counts.warned, skipped: counts.skipped, passed: counts.passed };
    const words = { failed: "failed", warned: "with warnings", skipped: "skipped", passed: "passed" };
    this.chips = KINDS.map((kind) =>
      element(
        "button",
        {
          type: "button",
          class: `chip ${kind}`,
          "aria-pressed": "true",
          "data-kind": kind,
          disabled: numbers[kind] === 0,
          title: `Show or hide cases that ${kind === "warned" ? "have warnings" : kind === "skipped" ? "were skipped" : kind}`,
          onclick: () => this.toggleKind(kind),
        },
        element("b", {}, numbers[kind]),
        ` ${words[kind]}`,
      ),
    );
    this.search = element("input", {
      type: "search",
      placeholder: "Name or tag",
      "aria-label": "Name or tag",
      oninput: () => this.filter(),
    });
    this.themeButton = element("button", {
      type: "button",
      title: "Light, dark, or as the system (l)",
      onclick: () => this.nextTheme(),
    });
    const keys = element("button", { type: "button", title: "Keys (?)", onclick: () => this.showKeys() }, "Keys");
    const environment = report.environment;
    const parts = [
      element(
        "div",
        { class: "title" },
        element("h1", {}, suiteName(report)),
        verdictMark(report.interrupted ? "interrupted" : report.verdict),
        element(
          "span",
          { class: "quiet" },
          `${counts.cases} cases in ${seconds(report.seconds)}, ${report.started.replace("T", " ").replace("Z", " UTC")}`,
        ),
      ),
      element(
        "p",
        { class: "quiet line" },
        [
          environment.renderer,
          `Mesa ${environment.mesa || "?"}`,
          environment.cpu,
          environment.commit && `commit ${environment.commit.slice(0, 12)}`,
        ]
          .filter(Boolean)
          .join(" \u00b7 "),
      ),
      element(
        "div",
        { class: "bar" },
        element("div", { class: "chips", role: "group", "aria-label": "Show" }, this.chips),
        this.search,
        this.themeButton,
        keys,
      ),
      report.approve ? commandLine("Approve all", report.approve) : null,
      report.orphans.length
        ? element(
            "div",
            { class: "orphans" },
            element("b", {}, "These goldens belong to no case; remove them, or correct the case:"),
            element(
              "ul",
              {},
              report.orphans.map((path) => element("li", {}, element("code", {}, path))),
            ),
          )
        : null,
    ];
    document.getElementById("head").append(...parts.filter(Boolean));
    this.nameTheme();
  }
  buildFoot() {
    const { report } = this,
      { environment } = report;
    document.getElementById("environment").append(
      element("h2", {}, "Environment"),
      facts([
        ["Suite", report.document],
        ["Renderer", environment.renderer],
        ["Driver", environment.version],
        ["Mesa", environment.mesa],
        ["LLVM", environment.llvm],
        ["Backend", environment.backend],
        ["CPU", environment.cpu],
        ["Cores, cases at a time", `${environment.threads}, ${environment.jobs}`],
        ["Commit", environment.commit],
        ["Aftershade", environment.aftershade],
        ["Renderer's name in files", environment.key],
        ["Filters", report.filters.join(", ")],
        ["Exit code", String(report.exit_code)],
      ]),
    );
    document.getElementById("keys").append(
      element("h2", {}, "Keys"),
      element(
        "dl",
        { class: "facts" },
        KEYS.map(([keys, words]) => element("div", {}, element("dt", {}, keys), element("dd", {}, words))),
      ),
      element("form", { method: "dialog" }, element("button", {}, "Close")),
    );
  }

  // ---- cases ----

  buildCases() {
    const worst = ["file error", "different size or channels", "failure", "warning", "same"];
    const ordered = [...this.report.cases].sort(
      (a, b) =>
        KINDS.indexOf(kindOf(a)) - KINDS.indexOf(kindOf(b)) ||
        worst.indexOf(a.verdict) - worst.indexOf(b.verdict) ||
        failingPercent(b) - failingPercent(a),
    );
    this.cards = ordered.map((test) => ({ test, node: safeCaseCard(test, this.report, this.viewers) }));
    this.none = element("p", { class: "quiet", hidden: true }, "No case matches.");
    const list = document.getElementById("cases");
    list.append(...this.cards.map(({ node }) => node), this.none);
    list.classList.toggle("many", ordered.length > 100);
  }
  toggleKind(kind) {
    if (!this.kinds.delete(kind)) this.kinds.add(kind);
    this.filter();
  }
  filter() {
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const chip of this.chips) chip.setAttribute("aria-pressed", String(this.kinds.has(chip.dataset.kind)));
    for (const { test, node } of this.cards) {
      const text = [test.name, ...test.tags].join(" ").toLowerCase();
      const isWanted = this.kinds.has(kindOf(test)) && words.every((word) => text.includes(word));
      node.hidden = !isWanted || this.review?.shows(test) === false;
    }
    this.none.hidden = this.cards.some(({ node }) => !node.hidden);
  }
  showCase(test) {
    const { node } = this.cards.find((card) => card.test === test);
    node.open = true;
    node.scrollIntoView({ block: "start" });
    node.querySelector("summary").focus({ preventScroll: true });
  }
  /** index.html#case-bokeh/lens opens that case. */
  openLinked() {
    let name = location.hash.slice(1);
    try {
      name = decodeURIComponent(name);
    } catch {
      /* a sign of per cent that encodes nothing */
    }
    const card = document.getElementById(name);
    if (!card?.classList.contains("case")) return;
    card.open = true;
    card.scrollIntoView({ block: "start" });
  }

  // ---- keys and themes ----

  showKeys() {
    document.getElementById("keys").showModal();
  }
  savedTheme() {
    try {
      return localStorage.getItem("aftershade-theme") ?? "system";
    } catch {
      return "system"; // pages from files may have no storage
    }
  }
  setTheme(theme) {
    this.theme = theme;
    if (theme === "system") document.documentElement.removeAttribute("data-theme");
    else document.documentElement.dataset.theme = theme;
  }
  nextTheme() {
    const themes = ["system", "light", "dark"];
    this.setTheme(themes[(themes.indexOf(this.theme) + 1) % themes.length]);
    this.nameTheme();
    try {
      localStorage.setItem("aftershade-theme", this.theme);
    } catch {
      /* as above */
    }
  }
  nameTheme() {
    this.themeButton.textContent = { system: "System colours", light: "Light", dark: "Dark" }[this.theme];
  }
  /** The case that keys are for: that of the focus, else of the current viewer. */
  chosenCard() {
    const chosen = this.viewers.visible().includes(this.viewers.current)
      ? this.viewers.current.node.closest(".case")
      : null;
    const node = document.activeElement.closest(".case") ?? chosen;
    return this.cards.find((card) => card.node === node);
  }
  copyApproval() {
    const chosen = this.chosenCard();
    if (!chosen) return tell("Choose a case first (j, k)");
    const { test, node: card } = chosen;
    if (!test.approve) return tell(`${test.name}: nothing to approve`);
    copy(test.approve, card.querySelector(".command code"), `Copied the command that approves ${test.name}`);
  }
  key(event) {
    // Keys with AltGr (Option on a Mac) come with Ctrl and Alt: brackets of many keyboards are such.
    const isTyped =
      event.getModifierState("AltGraph") || (event.altKey && event.key.length === 1 && "[]{}\\".includes(event.key));
    if (((event.ctrlKey || event.metaKey || event.altKey) && !isTyped) || event.target.closest("dialog")) return;
    const field = event.target.closest("input, select, textarea");
    if (field && event.key === "Escape") return field.blur();
    // A slider keeps the keys that move it, a field of text all of them, a button those that press it.
    if (
      field &&
      ((field.type !== "range" && field.type !== "checkbox") || event.key.startsWith("Arrow") || event.key === " ")
    )
      return;
    if (event.target.closest("button, summary, a") && [" ", "Enter"].includes(event.key)) return;
    const acts = {
      j: () => this.viewers.step(1),
      k: () => this.viewers.step(-1),
      "/": () => this.search.focus(),
      "?": () => this.showKeys(),
      l: () => this.nextTheme(),
      c: () => this.copyApproval(),
      o: () => {
        const card = this.viewers.current?.node.closest(".case");
        if (card) card.open = !card.open;
      },
    };
    if (acts[event.key]) acts[event.key]();
    else if (!this.review?.key(event.key, this.chosenCard()?.test)) {
      const visible = this.viewers.visible();
      if (visible.length && !visible.includes(this.viewers.current)) this.viewers.choose(visible[0]);
      if (!this.viewers.current?.key(event)) return;
    }
    event.preventDefault();
  }
}

new Page(pageReport());
