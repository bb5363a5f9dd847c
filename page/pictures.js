// Requests pictures: a coarse one first, then the full one. The newest wish wins.
import { SUPERSEDED, picture } from "./api.js";

const COARSE = 4, // fraction of the size of the first picture: 1/4
  QUICK_MS = 90; // a full picture that arrives this soon needs no coarse one before it

export class Pictures extends EventTarget {
  #wish = null;
  #isRunning = false;
  #stopping = null;
  #fullMs = Infinity;
  #other = { key: "" };
  #waiting = [];

  /** wish: {revision, frame, view, other, exposure, continues}; `other` is a view to compare with, or "". */
  want(wish) {
    this.#wish = wish;
    this.#stopping?.abort(); // a full picture that is no longer wanted
    if (!this.#isRunning) this.#run();
  }

  /** Resolves when no picture is under way. */
  settled() {
    return this.#isRunning ? new Promise((resolve) => this.#waiting.push(resolve)) : Promise.resolve();
  }

  async #run() {
    this.#isRunning = true;
    this.dispatchEvent(new Event("busy"));
    let retries = 0;
    while (this.#wish) {
      const wish = this.#wish;
      this.#wish = null;
      try {
        await this.#fetch(wish);
        retries = 0;
      } catch (error) {
        if (error.name === "AbortError") continue;
        // Superseded: by the newer wish, or else by another page, which ends soon.
        if (error.status === SUPERSEDED && !this.#wish && retries++ < 3) {
          await new Promise((resolve) => setTimeout(resolve, 200));
          this.#wish ??= wish;
        } else if (!this.#wish) this.dispatchEvent(new CustomEvent("fail", { detail: error }));
      }
    }
    this.#isRunning = false;
    this.dispatchEvent(new Event("idle"));
    for (const resolve of this.#waiting.splice(0)) resolve();
  }

  async #fetch(wish) {
    const values = ({ view }, scale) => ({
      revision: wish.revision,
      frame: wish.frame,
      scale,
      view,
      exposure: wish.exposure,
      ...(wish.continues && { continues: 1 }),
    });
    const show = (name, { bitmap, times }, isCoarse, ms) =>
      this.dispatchEvent(new CustomEvent("picture", { detail: { name, bitmap, times, isCoarse, wish, ms } }));
    const views = [["first", wish.view]];
    const otherKey = JSON.stringify([
      wish.other,
      wish.frame,
      wish.exposure,
      wish.other.startsWith("role:") || wish.revision,
    ]);
    if (wish.other && wish.other !== "kept" && otherKey !== this.#other.key) views.push(["second", wish.other]);

    if (this.#fullMs > QUICK_MS)
      for (const [name, view] of views) {
        // A coarse picture is let come even if it is not the newest: a drag shows what it passes.
        const begun = performance.now();
        show(name, await picture(values({ view }, COARSE)), true, performance.now() - begun);
        if (this.#wish) return;
      }
    this.#stopping = new AbortController();
    try {
      for (const [name, view] of views) {
        const begun = performance.now();
        const found = await picture(values({ view }, 1), this.#stopping.signal);
        if (name === "first") this.#fullMs = performance.now() - begun;
        else this.#other.key = otherKey;
        show(name, found, false, performance.now() - begun);
      }
    } finally {
      this.#stopping = null;
    }
  }

  /** The picture to compare with is gone; the next wish requests it again. */
  forgetOther() {
    this.#other.key = "";
  }
}
