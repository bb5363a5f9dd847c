// Where the page's data come from: elements of the page, or the server of `aftershade golden serve`.

const isServed = !document.getElementById("report");

/** Of the address that the server printed. */
const token = new URLSearchParams(location.hash.slice(1)).get("token") ?? "";

/** The server's answer; an Error with its message, and `answer` where it is JSON. */
async function ask(path, body) {
  const post = { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) };
  const options = body ? post : { headers: {} };
  options.headers["X-Aftershade-Token"] = token;
  let response;
  try {
    response = await fetch(path, options);
  } catch {
    throw new Error(
      "the program does not answer: start `aftershade golden serve` again and open the address that it prints",
    );
  }
  if (response.ok) return response;
  const answer = await response.json().catch(() => ({}));
  throw Object.assign(new Error(answer.error ?? `${response.status} ${response.statusText}`), { answer });
}

const askJson = async (path, body) => (await ask(path, body)).json();

const served = isServed
  ? await askJson("/api/report").catch((error) => {
      document.getElementById("cases").textContent = error.message;
      throw error;
    })
  : null;

const pageReport = () => served?.report ?? JSON.parse(document.getElementById("report").textContent);

const textOf = (index) => served?.texts[index] ?? document.getElementById(`data-${index}`).textContent;

function bytesOf(text) {
  const letters = atob(text),
    bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i); // .from() takes seconds for large pictures
  return bytes;
}

const addressesOfPngs = new Map();

/** The server's policy lets pictures come from blobs alone. */
function pngAddress(index) {
  if (!isServed) return `data:image/png;base64,${textOf(index)}`;
  if (!addressesOfPngs.has(index))
    addressesOfPngs.set(index, URL.createObjectURL(new Blob([bytesOf(textOf(index))], { type: "image/png" })));
  return addressesOfPngs.get(index);
}

/** Where a file of the report lies, from the page. */
const addressOf = (report, path) => `${report.folder}/${path}`.split("/").map(encodeURIComponent).join("/");

/** Of a PNG beside the page, which a server sends to those who have the token. */
async function pictureAddress(report, path) {
  if (!isServed) return addressOf(report, path);
  const response = await ask(`/api/picture?${new URLSearchParams({ name: path })}`);
  return URL.createObjectURL(await response.blob());
}
