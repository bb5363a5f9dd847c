// The look as the program holds it: one edit at a time, newest value of a drag first, undo in steps that a person made.
import { ApiError, get, post } from "./api.js";

export class Store extends EventTarget {
  state = null;
  effects = new Map();
  #queue = [];
  #running = null;
  /** Number of the program's edits that each of the person's edits took: a drag takes many. */
  #done = [];
  #undone = [];
  #gesture = null;

  async load() {
    await this.#takeWithEffects(await get("/api/state"));
  }

  /** Warnings are no faults: the picture is drawn with them. */
  get hasFaults() {
    return this.state.faults.some(({ severity }) => severity !== "warning");
  }
  /** Of a new step. What comes after a view transform has no scene colour to work on. */
  get lastPlace() {
    const { steps } = this.state;
    return steps.at(-1)?.effect === "view_transform" ? steps.length - 1 : steps.length;
  }
  get isSaved() {
    return this.state.revision === this.state.saved_revision;
  }

  async #takeWithEffects(state) {
    if (state.effects_revision !== this.state?.effects_revision) {
      const effects = await get("/api/effects");
      this.effects = new Map(effects.map((effect) => [effect.id, effect]));
    }
    this.#take(state);
  }

  #take(state) {
    this.state = state;
    this.dispatchEvent(new Event("change"));
  }

  #fail(error) {
    this.dispatchEvent(new CustomEvent("fail", { detail: error }));
  }

  /**
   * Sends edits. Edits with the same `gesture` are one step of undo, and of those that wait only the newest is sent.
   * Resolves to true when the program has taken them.
   */
  edit(edits, gesture = null) {
    if (this.state.read_only) {
      this.#fail(new ApiError(403, "the program was started with --read-only"));
      return Promise.resolve(false);
    }
    const last = this.#queue.at(-1);
    if (gesture && last?.gesture === gesture) {
      last.edits = edits;
      return last.promise;
    }
    const job = { edits, gesture };
    job.promise = new Promise((resolve) => (job.resolve = resolve));
    this.#queue.push(job);
    this.#running ??= this.#run();
    return job.promise;
  }

  async #run() {
    while (this.#queue.length) {
      const job = this.#queue.shift();
      job.resolve(await (job.work ? job.work() : this.#send(job)));
    }
    this.#running = null;
  }

  async #send({ edits, gesture }) {
    try {
      const before = this.state.revision;
      const state = await post("/api/edit", { revision: before, edits });
      if (state.revision !== before) {
        if (gesture && gesture === this.#gesture && this.#done.length) this.#done[this.#done.length - 1] += 1;
        else this.#done.push(1);
        this.#undone = [];
        this.#gesture = gesture;
      }
      this.#take(state);
      return true;
    } catch (error) {
      this.#fail(error);
      await this.refresh();
      return false;
    }
  }

  /** Work that waits for its turn behind the edits. */
  #inTurn(work) {
    const job = { work };
    job.promise = new Promise((resolve) => (job.resolve = resolve));
    this.#queue.push(job);
    this.#running ??= this.#run();
    return job.promise;
  }

  #step(path, from, to, possible) {
    return this.#inTurn(async () => {
      try {
        const count = from.pop() ?? 1;
        let state = this.state;
        for (let i = 0; i < count && state[possible]; ++i) state = await post(path);
        if (state !== this.state) to.push(count);
        this.#gesture = null;
        this.#take(state);
        return true;
      } catch (error) {
        this.#fail(error);
        return false;
      }
    });
  }
  undo() {
    return this.#step("/api/undo", this.#done, this.#undone, "can_undo");
  }
  redo() {
    return this.#step("/api/redo", this.#undone, this.#done, "can_redo");
  }

  /** `name` is that of a look that has none yet. */
  save(name) {
    return this.#write("/api/save", name ? { name } : {});
  }
  /** {name, bytes}: a file or a folder that was dropped on the page. */
  takeCapture(dropped) {
    return this.#write("/api/capture", dropped);
  }

  /** shader: {effect, file, before, text}; `before` is what the file is thought to hold. */
  saveShader(shader) {
    return this.#write("/api/shader", shader);
  }
  /** {folder, effect}: an effect from the templates of `aftershade new`. */
  newEffect(effect) {
    return this.#write("/api/effect", effect);
  }
  #write(path, body) {
    return this.#inTurn(async () => {
      try {
        await this.#takeWithEffects(await post(path, body));
        return true;
      } catch (error) {
        this.#fail(error);
        return false;
      }
    });
  }

  /** Reads the effects and the look again where another program has changed their files. */
  followFiles() {
    if (this.#running) return this.#running; // the next call follows
    return this.#inTurn(async () => {
      try {
        const { path, ...found } = await get("/api/changes"),
          isNew = Object.keys(found).some((key) => found[key] !== this.state[key]);
        if (found.effects_revision !== this.state.effects_revision) await this.#takeWithEffects(await get("/api/state"));
        else if (isNew || path !== this.state.look.path) await this.refresh();
        return true;
      } catch (error) {
        this.#fail(error);
        return false;
      }
    });
  }

  /** Reads the state again; another page may have changed it. */
  async refresh() {
    try {
      const state = await get("/api/state");
      if (state.revision !== this.state.revision) {
        this.#done = [];
        this.#undone = [];
      }
      await this.#takeWithEffects(state);
    } catch (error) {
      this.#fail(error);
    }
  }
}
