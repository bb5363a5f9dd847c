// Decisions about the cases that differ: kept by the server, or handed back as a file.

/** A case that waits for a decision. */
const isReviewable = (test) => kindOf(test) === "failed" || kindOf(test) === "warned";

const seenImages = (test) =>
  test.images.map(({ name, hashes }) => ({ name, test: hashes.test, reference: hashes.reference }));

/** Decisions of a page without a server: they last until they are downloaded. */
class OwnDecisions {
  constructor() {
    this.all = new Map();
    this.name = "";
    addEventListener("beforeunload", (event) => this.isUnsaved && event.preventDefault());
  }
  get finishWords() {
    return "Download decisions";
  }
  async load() {}
  async decide(wishes, byName) {
    for (const { case: name, decision, note } of wishes) {
      const test = byName.get(name),
        adds = test.images.some((image) => image.verdict !== "same" && image.only_machine_changed);
      if (decision === "none") this.all.delete(name);
      else
        this.all.set(name, {
          case: name,
          decision,
          note,
          by: this.name,
          images: seenImages(test),
          ...(decision === "approve" && adds ? { add: true } : {}),
        });
    }
    this.isUnsaved = this.all.size > 0;
  }
  async finish() {
    const decisions = [...this.all.values()].map((one) => ({ ...one, by: this.name }));
    const text = JSON.stringify({ aftershade: 1, decisions }, null, 1);
    const address = URL.createObjectURL(new Blob([text], { type: "application/json" }));
    element("a", { href: address, download: "decisions.json" }).click();
    setTimeout(() => URL.revokeObjectURL(address), 60_000);
    this.isUnsaved = false;
    return "Downloaded. Apply them with: aftershade golden apply-approvals SUITE decisions.json";
  }
}

/** Decisions that the server keeps, of everyone who reviews this report. */
class ServedDecisions {
  constructor() {
    this.all = new Map();
    this.name = served.review.reviewer;
  }
  get finishWords() {
    return "Write approved images";
  }
  take({ decisions, writing }) {
    this.text = null;
    this.all = new Map(decisions.map((one) => [one.case, one]));
    this.writing = writing;
  }
  /** Whether something is new. */
  async load() {
    const answer = await askJson("/api/decisions"),
      text = JSON.stringify(answer),
      isNew = text !== this.text;
    if (isNew) this.take(answer);
    this.text = text;
    return isNew;
  }
  async decide(wishes) {
    const before = ({ case: name }) => this.all.get(name)?.revision ?? "";
    try {
      this.take(await askJson("/api/decide", { decisions: wishes.map((wish) => ({ ...wish, before: before(wish) })) }));
    } catch (error) {
      if (error.answer?.decisions) this.take(error.answer);
      throw error;
    }
  }
  async finish() {
    const answer = await askJson("/api/write", {});
    this.take(answer);
    const words = [`Written: ${answer.written.length} images.`];
    if (answer.kept.length) words.push("Not written:", ...answer.kept);
    return [...words, ...answer.warnings].join("\n");
  }
}

const POLL_MS = 2000; // until another reviewer's decision is seen

/** What the page shows of decisions, and how they are made. */
class Review {
  constructor(report, page) {
    this.page = page;
    this.cases = report.cases.filter(isReviewable);
    this.byName = new Map(this.cases.map((test) => [test.name, test]));
    this.causes = causesOf(report.cases);
    this.decisions = isServed ? new ServedDecisions() : new OwnDecisions();
    this.rows = new Map();
    this.history = []; // lists of names, of this page
    this.pending = new Set(); // names whose decision has no answer yet: a second click is about the same state
  }
  async start() {
    const bar = this.bar(),
      rows = this.page.cards.filter(({ test }) => this.byName.has(test.name));
    for (const { test } of rows) this.row(test);
    await this.refreshed(); // before anything can be clicked
    document.getElementById("head").append(bar);
    for (const { test, node } of rows) node.firstChild.after(this.rows.get(test.name).node);
    if (isServed) setInterval(() => document.hidden || this.refreshed(false), POLL_MS);
    addEventListener("beforeunload", (event) => this.hasOpenNote() && event.preventDefault());
  }
  /** Whether a note is written whose decision is not made: a reload would lose it. */
  hasOpenNote() {
    return [...this.rows.values()].some(({ note }) => !note.hidden && note.value.trim());
  }
  /** Shows what is decided; without `always` only where something is new, since hundreds of rows take long. */
  async refreshed(always = true) {
    try {
      const isNew = (await this.decisions.load()) || this.isAlone;
      if (this.isAlone) this.say("");
      this.isAlone = false;
      if (isNew || always) this.show();
    } catch (error) {
      // Once: what a decision answered stays readable.
      if (!this.isAlone) this.say(error.message, true);
      this.isAlone = true;
    }
  }

  // ---- what is decided ----

  /** One about other images than the page's does not count. */
  decisionOf(test) {
    const decision = this.decisions.all.get(test.name);
    return decision && decision.current !== false ? decision : null;
  }
  async decide(tests, decision, note = "") {
    const wishes = tests.map((test) => ({ case: test.name, decision, note }));
    for (const { name } of tests) this.pending.add(name);
    try {
      await this.decisions.decide(wishes, this.byName);
      if (decision !== "none") this.history.push(tests);
      this.say("");
    } catch (error) {
      const all = error.answer?.conflicts ?? [error.message];
      this.say(["Nothing was changed.", ...all, "Look again, then decide."].join("\n"), true);
    }
    for (const { name } of tests) this.pending.delete(name);
    this.show();
  }
  /** The open cases of the list are approved; a decision that stands is left alone. */
  approveOpen(tests) {
    const open = tests.filter((test) => test.approve && !this.decisionOf(test) && !this.pending.has(test.name));
    if (open.length === 0) return tell("Every case of this cause is decided");
    return this.decide(open, "approve");
  }
  /** Takes back what this page decided last, as far as no one has decided otherwise since. */
  undo() {
    const isOwn = ({ by, written }) => (!isServed || by === this.decisions.name) && !written;
    while (this.history.length) {
      const tests = this.history.pop().filter((test) => this.decisionOf(test) && isOwn(this.decisionOf(test)));
      if (tests.length) return this.decide(tests, "none");
    }
    return tell("There is nothing to undo");
  }
  async finish() {
    if (!isServed && !this.nameField.value.trim()) {
      this.nameField.focus();
      return this.say("Write your name and address first: Ada <ada@example.org>", true);
    }
    this.finishButton.disabled = true;
    if (isServed) this.say("Drawing the approved cases again\u2026");
    try {
      this.say(await this.decisions.finish());
    } catch (error) {
      this.say(error.message, true);
    }
    await this.refreshed();
  }

  // ---- elements ----

  say(words, isFault = false) {
    this.words.textContent = words;
    this.words.classList.toggle("missing", isFault);
  }
  bar() {
    const button = (words, title, onclick) => element("button", { type: "button", title, onclick }, words);
    this.sums = element("b", {});
    this.words = element("p", { class: "review-words", role: "status", "aria-live": "polite" });
    this.finishButton = button(
      this.decisions.finishWords,
      isServed
        ? "Draw the approved cases and write their images into the suite"
        : "Save a file for `aftershade golden apply-approvals`",
      () => this.finish(),
    );
    this.finishButton.classList.add("finish");
    this.nameField = element("input", {
      type: "text",
      placeholder: "Ada <ada@example.org>",
      "aria-label": "Your name and address",
      maxlength: 200,
      oninput: () => (this.decisions.name = this.nameField.value.trim()),
    });
    this.shownSelect = element(
      "select",
      { "aria-label": "Decisions to show", onchange: () => this.page.filter() },
      ["all", "undecided", "approved", "rejected"].map((kind) => element("option", { value: kind }, kind)),
    );
    return element(
      "section",
      { class: "review", "aria-label": "Review" },
      element(
        "div",
        { class: "bar" },
        this.sums,
        element("label", { class: "group" }, "Show ", this.shownSelect),
        button("Undo", "Take the last decision of this page back (u)", () => this.undo()),
        isServed
          ? element(
              "span",
              { class: "quiet" },
              `You decide as ${this.decisions.name || "no one: git has no user.name"}`,
            )
          : this.nameField,
        this.finishButton,
      ),
      this.words,
      this.causeList(),
    );
  }
  causeList() {
    this.causeRows = this.causes.map((cause) => {
      const open = element("span", { class: "quiet" });
      const approve = element("button", { type: "button", onclick: () => this.approveOpen(cause.cases) });
      const show = element("button", { type: "button", onclick: () => this.page.showCase(cause.cases[0]) }, "Look");
      show.setAttribute("aria-label", `Look at the first case of: ${cause.title}`);
      return {
        cause,
        open,
        approve,
        node: element("li", {}, element("span", {}, cause.title, " ", open), show, approve),
      };
    });
    return element(
      "details",
      { class: "causes", open: this.causes.length < this.cases.length },
      element("summary", {}, `By cause (${this.causes.length})`),
      element(
        "ul",
        {},
        this.causeRows.map(({ node }) => node),
      ),
    );
  }
  row(test) {
    const note = element("input", {
      type: "text",
      placeholder: "Why (needed to reject)",
      maxlength: 500,
      "aria-label": `Note about ${test.name}`,
    });
    const state = element("span", { class: "state" });
    const act = (words, decision) =>
      element(
        "button",
        {
          type: "button",
          "aria-label": `${words} ${test.name}`,
          "data-decision": decision,
          onclick: () => this.act(test, decision),
        },
        words,
      );
    const buttons = [act("Approve", "approve"), act("Reject", "reject"), act("Undo", "none")];
    const node = element(
      "div",
      { class: "decision", role: "group", "aria-label": `Decision about ${test.name}` },
      buttons,
      note,
      state,
    );
    this.rows.set(test.name, { test, node, note, state, buttons });
    return node;
  }
  act(test, decision) {
    const { note, buttons } = this.rows.get(test.name),
      words = note.value.trim();
    if (this.pending.has(test.name)) return tell("Its decision is on its way");
    if (buttons.find((button) => button.dataset.decision === decision).disabled)
      return tell("It is decided; take the decision back first");
    if (decision === "reject" && !words) {
      note.focus();
      return tell("Write why, then reject");
    }
    return this.decide([test], decision, decision === "none" ? "" : words);
  }
  /** A key of the page. False where there is none. */
  key(key, test) {
    if (key === "u") this.undo();
    else if (!test || !this.byName.has(test.name) || !"yng".includes(key)) return false;
    else if (key === "y") test.approve ? this.act(test, "approve") : tell("It has no image to approve");
    else if (key === "n") this.act(test, "reject");
    else if (key === "g") this.approveOpen(this.causes.find(({ cases }) => cases.includes(test))?.cases ?? []);
    return true;
  }

  // ---- what is shown ----

  stateWords(test, decision) {
    const other = this.decisions.all.get(test.name);
    if (!decision)
      return other
        ? `Was ${other.decision === "approve" ? "approved" : "rejected"} by ${other.by} for other images`
        : "";
    const verb = decision.written ? "Written; approved" : decision.decision === "approve" ? "Approved" : "Rejected";
    return `${verb} by ${decision.by || this.decisions.name || "you"}${decision.note ? `: ${decision.note}` : ""}`;
  }
  show() {
    const counts = { approve: 0, reject: 0, open: 0, waiting: 0 };
    for (const { test, node, note, state, buttons } of this.rows.values()) {
      const decision = this.decisionOf(test);
      counts[decision?.decision ?? "open"] += 1;
      if (decision?.decision === "approve" && !decision.written) counts.waiting += 1;
      node.dataset.state = decision?.decision ?? "open";
      state.textContent = this.stateWords(test, decision);
      note.hidden = decision !== null;
      const [approve, reject, undo] = buttons;
      approve.disabled = !test.approve || decision !== null;
      reject.disabled = decision !== null;
      undo.disabled = false;
      undo.hidden = decision === null || !!decision.written;
    }
    const { approve, reject, open, waiting } = counts;
    this.sums.textContent = `${approve} approved, ${reject} rejected, ${open} to decide`;
    const { writing } = this.decisions;
    if (writing) this.say(`Drawing the approved cases again: ${writing.done} of ${writing.all}`);
    this.finishButton.disabled = !!writing || (isServed ? waiting : approve + reject) === 0;
    for (const row of this.causeRows) this.showCause(row);
    this.page.filter();
  }
  showCause({ cause, open, approve }) {
    const left = cause.cases.filter((test) => !this.decisionOf(test)).length;
    open.textContent = left === 0 ? "all decided" : `${left} of ${cause.cases.length} to decide`;
    approve.textContent = `Approve ${left}`;
    approve.setAttribute("aria-label", `Approve ${left}: ${cause.title}`);
    approve.disabled = left === 0;
  }
  /** Whether the choice of decisions to show has the case. */
  shows(test) {
    const wanted = this.shownSelect.value,
      state = this.decisionOf(test)?.decision ?? "open";
    return (
      wanted === "all" ||
      { undecided: "open", approved: "approve", rejected: "reject" }[wanted] ===
        (this.byName.has(test.name) ? state : "none")
    );
  }
}
