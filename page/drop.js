// A picture or a folder dropped on the page becomes the capture, where the program may read it. Browsers tell its name
// and size alone, so the program looks for it below the capture that it was started with.
import { notify } from "./elements.js";

/** {name, bytes} of a file, {name} of a folder; null of anything else. */
export function droppedThing({ items }) {
  const item = [...items].find(({ kind }) => kind === "file"),
    entry = item?.webkitGetAsEntry?.();
  if (entry?.isDirectory) return { name: entry.name };
  const file = item?.getAsFile();
  return file && { name: file.name, bytes: file.size };
}

export function acceptDrops(store) {
  const { documentElement } = document,
    hasFiles = ({ dataTransfer }) => dataTransfer?.types.includes("Files");
  addEventListener("dragover", (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    documentElement.classList.add("dropping");
  });
  addEventListener("dragleave", ({ relatedTarget }) => relatedTarget || documentElement.classList.remove("dropping"));
  addEventListener("drop", async (event) => {
    documentElement.classList.remove("dropping");
    if (!hasFiles(event)) return;
    event.preventDefault();
    const dropped = droppedThing(event.dataTransfer);
    if (dropped && (await store.takeCapture(dropped))) notify(`The capture is ${store.state.capture.path}`);
  });
}
