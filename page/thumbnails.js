// Small pictures, one after the other, drawn by a process of their own: no picture of the viewer waits for them.
import { thumbnail } from "./api.js";

export class Thumbnails {
  #queue = [];
  #isRunning = false;
  #stopping = new AbortController();
  #wanted = new WeakMap();
  #kept = new Map();

  constructor(store, viewer) {
    this.store = store;
    this.viewer = viewer;
    this.observer = new IntersectionObserver((entries) => {
      for (const { isIntersecting, target } of entries) {
        if (!isIntersecting) continue;
        this.observer.unobserve(target);
        this.#queue.push(target);
      }
      if (!this.#isRunning) this.#run();
    });
  }

  /** Once the canvas is seen, it gets the picture of the look after `edits`. */
  want(canvas, edits) {
    this.#wanted.set(canvas, edits);
    this.observer.observe(canvas);
  }

  /** Those that have not begun are not drawn. */
  stop() {
    this.observer.disconnect();
    this.#queue = [];
    this.#stopping.abort();
    this.#stopping = new AbortController();
  }

  async #run() {
    this.#isRunning = true;
    while (this.#queue.length) {
      await this.viewer.pictures.settled();
      const canvas = this.#queue.shift();
      if (canvas?.isConnected) await this.#draw(canvas);
    }
    this.#isRunning = false;
  }

  async #draw(canvas) {
    const { text, effects_revision, capture } = this.store.state,
      { frame } = this.viewer,
      edits = this.#wanted.get(canvas),
      isWhole = edits.length === 1 && edits[0].op === "text",
      key = JSON.stringify([capture.path, frame, effects_revision, isWhole ? "" : text, edits]);
    try {
      const bitmap = this.#kept.get(key) ?? (await thumbnail(frame, edits, this.#stopping.signal));
      this.#kept.set(key, bitmap);
      [canvas.width, canvas.height] = [bitmap.width, bitmap.height];
      canvas.getContext("2d").drawImage(bitmap, 0, 0);
      canvas.dataset.drawn = "";
    } catch (error) {
      canvas.title = error.message;
    }
  }
}
