// What may stand at a place of a look's text, by the JSON schema that the program makes of looks.

/**
 * The place of a character in JSON that may not be whole: {path: keys and indices, isKey, begin, end, typed, objects: what
 * each object around it has so far}. null in a comment.
 */
export function placeAt(text, at) {
  const around = []; // {isList, key, index, members}
  let isKey = false,
    i = 0;
  const top = () => around.at(-1);
  const place = (begin, end, typed) => ({
    path: around.flatMap((one, level) => {
      const isLast = level === around.length - 1;
      if (one.isList) return [one.index];
      return isLast && isKey ? [] : [one.key];
    }),
    objects: around.map(({ members }) => members),
    isKey,
    begin,
    end,
    typed,
  });
  while (i < at) {
    const rest = text.slice(i),
      comment = /^\/\/[^\n]*/.exec(rest)?.[0],
      string = /^"(?:[^"\\\n]|\\.)*"?/.exec(rest)?.[0],
      word = /^[-+.\w]+/.exec(rest)?.[0],
      found = comment ?? string ?? word ?? text[i];
    if (comment && i + comment.length >= at) return null;
    const stop = i + found.length;
    if (string && at < (string.length > 1 && string.endsWith('"') ? stop : stop + 1)) {
      // A quote that was just typed may run into the next string: only a word up to a quote belongs to it.
      const rest = /^[-\w.]*"?/.exec(text.slice(at, stop))[0];
      return { ...place(i, at + rest.length, text.slice(i + 1, at)), isQuoted: true };
    }
    if (word && at <= stop) return place(i, stop, text.slice(i, at));
    i += found.length;
    if (found === "{" || found === "[") {
      around.push({ isList: found === "[", index: 0, members: {} });
      isKey = found === "{";
    } else if (found === "}" || found === "]") {
      around.pop();
      isKey = false;
    } else if (found === ",") {
      if (top()?.isList) top().index += 1;
      isKey = Boolean(top()) && !top().isList;
    } else if (found === ":") isKey = false;
    else if (string || word) {
      const value = string ? string.slice(1, -1) : word;
      if (isKey) top().key = value;
      else if (top() && !top().isList) top().members[top().key] = value;
    }
  }
  return place(at, at, "");
}

/** The forms that a schema allows, with references followed; a branch with another "effect" than the object's is none. */
function forms(schema, root, members = {}) {
  if (!schema || typeof schema !== "object") return [];
  if (schema.$ref) return forms(root.$defs[schema.$ref.split("/").at(-1)], root, members);
  if (schema.if) return forms("use" in members ? schema.then : schema.else, root, members);
  const effect = schema.properties?.effect?.const;
  if (effect !== undefined && members.effect !== undefined && members.effect !== effect) return [];
  const inner = [...(schema.anyOf ?? []), ...(schema.oneOf ?? [])].flatMap((one) =>
    forms(one, root, members).map((form) => ({ description: schema.description, ...form })),
  );
  // Branches beside properties say which of them go together, and have none of their own.
  return schema.properties || !inner.length ? [schema, ...inner] : inner;
}

/** The schemas of one member or item of some forms. */
const inside = (all, key) =>
  all.flatMap((form) => {
    if (typeof key === "number") return form.items ? [form.items] : [];
    const pattern = Object.entries(form.patternProperties ?? {}).find(([text]) => new RegExp(text).test(key)),
      found = form.properties?.[key] ?? pattern?.[1] ?? form.additionalProperties;
    return found && typeof found === "object" ? [found] : [];
  });

const once = (entries) => [...new Map(entries.map((entry) => [entry.label, entry])).values()];

/** For Completion: keys and words of the schema at the character; `names` are those of objects, for values that name one. */
export function lookWords(text, at, schema, names = []) {
  const place = schema && placeAt(text, at);
  if (!place) return null;
  let all = forms(schema, schema, place.objects[0]);
  place.path.forEach((key, level) => {
    all = inside(all, key).flatMap((one) => forms(one, schema, place.objects[level + 1]));
  });
  const quoted = JSON.stringify,
    present = place.objects.at(-1) ?? {},
    isFollowed = /^\s*:/.test(text.slice(place.end));
  const keys = all.flatMap(({ properties = {} }) =>
    Object.entries(properties)
      .filter(([key]) => key === place.typed || !(key in present))
      .map(([key, one]) => ({
        label: key,
        insert: quoted(key) + (isFollowed ? "" : ": "),
        words: one.description ?? forms(one, schema)[0]?.description,
      })),
  );
  const values = all.flatMap((form) =>
    [
      ...(form.enum ?? []),
      ...("const" in form ? [form.const] : []),
      ...(form.type === "boolean" ? [true, false] : []),
    ].map((value) => ({ label: String(value), insert: quoted(value), words: form.description })),
  );
  const objects = ["object", "name"].includes(place.path.filter((key) => typeof key === "string").at(-1)) ? names : [];
  return {
    ...place,
    isOpen: place.isQuoted,
    entries: once(place.isKey ? keys : [...values, ...objects.map((name) => ({ label: name, insert: quoted(name) }))]),
  };
}
