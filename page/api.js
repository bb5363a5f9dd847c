// Requests to the program that serves this page. The token comes with the address that it prints.

export const token = new URLSearchParams(location.hash.slice(1)).get("token") ?? "";

/** The status of a picture that was not drawn, because a newer one was requested. */
export const SUPERSEDED = 204;

export class ApiError extends Error {
  constructor(status, message) {
    super(message);
    this.status = status;
  }
}

async function answer(path, options) {
  try {
    return await fetch(path, { ...options, headers: { "X-Aftershade-Token": token, ...options.headers } });
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new ApiError(
      0,
      "the program does not answer: start `aftershade serve` again and open the address that it prints (to keep unsaved changes, press Look in the Export dialog)",
    );
  }
}

async function request(path, options = {}) {
  const response = await answer(path, options);
  if (response.status === SUPERSEDED) throw new ApiError(SUPERSEDED, "a newer request for a picture took its place");
  if (response.ok) return response;
  let message = `${response.status} ${response.statusText}`;
  try {
    message = (await response.json()).error ?? message;
  } catch {
    // The body is not JSON: the status stands alone.
  }
  throw new ApiError(response.status, message);
}

const query = (path, values) => `${path}?${new URLSearchParams(values)}`;

export const get = async (path, values = {}, options) => (await request(query(path, values), options)).json();

export const post = async (path, body = {}) =>
  (
    await request(path, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) })
  ).json();

const bitmapOf = async (response) =>
  createImageBitmap(await response.blob(), { premultiplyAlpha: "none", colorSpaceConversion: "none" });

/** {bitmap, times}: a picture and what it cost. */
export async function picture(values, signal) {
  const response = await request(query("/api/picture", values), { signal });
  const times = JSON.parse(response.headers.get("X-Aftershade-Times") ?? "null");
  return { bitmap: await bitmapOf(response), times };
}

/** A small picture of the look as it would be after `edits`. */
export const thumbnail = async (frame, edits, signal) =>
  bitmapOf(
    await request(query("/api/thumbnail", { frame }), { method: "POST", body: JSON.stringify({ edits }), signal }),
  );

/** The PNG itself. */
export const pictureBlob = async (values) => (await request(query("/api/picture", values))).blob();
