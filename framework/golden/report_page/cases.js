// A case of the suite: why it has its verdict, its pictures and figures, what approves it.

const KINDS = ["failed", "warned", "skipped", "passed"];

function kindOf(test) {
  if (!["same", "warning"].includes(test.verdict)) return "failed";
  if (test.skipped) return "skipped";
  return test.verdict === "warning" ? "warned" : "passed";
}

const seconds = (value) => `${value.toFixed(value < 10 ? 2 : 1)} s`;

/** JSON has no infinities: they come as words. */
function figure(value) {
  if (value === null || value === undefined) return "\u2013";
  return typeof value === "number"
    ? short(value)
    : ({ inf: "\u221e", "-inf": "-\u221e", nan: "NaN" }[value] ?? String(value));
}

const exactFigure = (value) => (typeof value === "number" ? exact(value) : figure(value));

/** What the failing pixels of a layer leave aside. */
function notCounted({ left_out_pixels: leftOut, forgiven_pixels: forgiven }) {
  return (leftOut ? `, ${leftOut} left out` : "") + (forgiven ? `, ${forgiven} forgiven` : "");
}

function metricsTable(image) {
  const heads = [
    "Layer",
    "Verdict",
    "Failing pixels",
    "Largest error",
    "at",
    "reference",
    "test",
    "RMSE",
    "MAE",
    "relMSE",
    "PSNR dB",
    "SSIM",
    "MS-SSIM",
    "LDR-FLIP",
    "HDR-FLIP",
    "NaN, Inf",
  ];
  const faulty = ({ nan, inf }) => (nan + inf ? `${nan}, ${inf}` : "none");
  const rows = image.comparison.layers.map((layer) => {
    const worst = layer.max_error;
    if (!layer.pixels)
      return [
        `${layer.layer} (${layer.role})`,
        layer.verdict,
        layer.left_out_pixels ? "every pixel is left out" : "no pixel in common",
        ...Array(heads.length - 3).fill("\u2013"),
      ];
    return [
      `${layer.layer} (${layer.role})`,
      layer.verdict,
      `${layer.failing.pixels} of ${layer.pixels} (${figure(layer.failing.percent)} %)${notCounted(layer)}`,
      figure(worst.value),
      worst.value === 0 ? "\u2013" : `${worst.x}, ${worst.y} ${worst.channel}`,
      exactFigure(worst.reference),
      exactFigure(worst.test),
      figure(layer.rmse),
      figure(layer.mean_absolute),
      figure(layer.relative_mse),
      figure(layer.psnr_db),
      figure(layer.ssim),
      figure(layer.ms_ssim),
      figure(layer.ldr_flip?.mean),
      figure(layer.hdr_flip?.mean),
      faulty(layer.test_non_finite) === faulty(layer.reference_non_finite)
        ? faulty(layer.test_non_finite)
        : `${faulty(layer.reference_non_finite)} \u2192 ${faulty(layer.test_non_finite)}`,
    ];
  });
  // A metric that no layer has takes no room.
  const used = heads.map((_, i) => i < 3 || rows.some((row) => row[i] !== "\u2013")),
    inUse = (cells) => cells.filter((_, i) => used[i]);
  return element(
    "div",
    { class: "wide", tabindex: 0, role: "group", "aria-label": `Figures of ${image.name}` },
    table(inUse(heads), rows.map(inUse), { class: "metrics" }),
  );
}

function toleranceWords(rules) {
  const words = [bothLevels(rules)];
  if (rules.nan_equal) words.push("NaN equals NaN");
  if (rules.forgive_shift_px) words.push(`forgives a shift of up to ${rules.forgive_shift_px} px`);
  if (rules.forgive_blur_px) words.push(`forgives a blur of sigma ${figure(rules.forgive_blur_px)} px`);
  for (const [layer, own] of Object.entries(rules.layers ?? {})) words.push(`layer ${layer} ${bothLevels(own)}`);
  for (const own of rules.areas ?? []) words.push(`area ${own.area} ${bothLevels(own)}`);
  for (const area of rules.ignore ?? []) words.push(`leaves out ${area}`);
  return words.join("; ");
}

function bothLevels({ fail, warn }) {
  const same = !warn || JSON.stringify(warn) === JSON.stringify(fail);
  return [levelWords("fails", fail), same ? null : levelWords("warns", warn)].filter(Boolean).join("; ");
}

function levelWords(does, { limit, percent, hard, allowed, flip, ssim }) {
  return [
    `${does} above ${figure(limit)}`,
    percent ? `in more than ${figure(percent)} % of pixels` : null,
    allowed ? `${allowed} pixels allowed` : null,
    hard === "inf" ? null : `any pixel above ${figure(hard)}`,
    flip === null ? null : `FLIP above ${figure(flip)}`,
    ssim === null ? null : `SSIM below ${figure(ssim)}`,
  ]
    .filter(Boolean)
    .join(", ");
}

/** The largest share of failing pixels of a layer; of an image that could not be compared, all. */
function failingPercent(test) {
  const shares = test.images.flatMap((image) =>
    image.comparison?.layers.length ? image.comparison.layers.map((layer) => layer.failing?.percent ?? 100) : [100],
  );
  return Math.max(0, ...shares);
}

function approvedWords(image) {
  if (!image.approved) return "none: this image is new";
  const others = image.approved_count > 1 ? ` (nearest of ${image.approved_count})` : "",
    made = image.approved.sidecar;
  return `${image.approved.file}${others}${made ? `, made by ${made.renderer}, Mesa ${made.mesa ?? "?"}, ${made.cpu}` : ", without a sidecar"}`;
}

/** Nothing is to be seen. NaN has equal bits, but is not a number to approve. */
const isAsApproved = (image) => image.bits_equal && image.verdict === "same";

function imageSection(image, report, viewers) {
  const parts = [];
  if (image.shown.missing)
    parts.push(element("p", { class: "missing" }, `Pictures are missing: ${image.shown.missing}`));
  else if (isAsApproved(image)) {
    parts.push(
      element(
        "p",
        { class: "quiet" },
        image.comparison?.layers.some((layer) => layer.left_out_pixels)
          ? "Every bit that is not left out is as approved."
          : "Every bit is as approved.",
      ),
      smallPicture(image, report, { class: "whole", alt: `${image.name}, as approved` }),
    );
  } else if (image.shown.layers.length || image.pictures.test) {
    const viewer = new Viewer(image, report);
    viewers.add(viewer);
    parts.push(viewer.node);
  }
  if (image.comparison?.layers.length) parts.push(metricsTable(image));
  const sidecar = image.approved?.sidecar;
  parts.push(
    facts([
      ["Approved", approvedWords(image)],
      [
        "Compared by",
        image.tier === "bits"
          ? "bits (renderer, Mesa, CPU, look and effects are those of the approved image)"
          : "tolerance",
      ],
      ["Tolerance", image.comparison ? toleranceWords(image.comparison.rules) : null],
      ["Approved by", [sidecar?.approver, sidecar?.approved].filter(Boolean).join(", ") || null],
      ["Approved with", sidecar?.command],
      [
        "Files",
        image.pictures.test_exr
          ? [image.pictures.reference_exr, image.pictures.test_exr]
              .filter(Boolean)
              .flatMap((path, i) => [
                i ? ", " : "",
                isServed ? path : element("a", { href: addressOf(report, path) }, path),
              ])
          : null,
      ],
    ]),
  );
  return element(
    "section",
    { class: "image" },
    element("h3", {}, image.name, " ", verdictMark(image.verdict)),
    ...parts,
  );
}

function verdictMark(verdict) {
  const kind = { same: "passed", warning: "warned", skipped: "skipped" }[verdict] ?? "failed";
  return element("span", { class: `mark ${kind}` }, verdict);
}

/** Each reason once, with the images that it is of. */
function reasonsOf(test) {
  const names = new Map();
  for (const image of test.images.filter((one) => one.verdict !== "same"))
    for (const reason of image.reasons) names.set(reason, [...(names.get(reason) ?? []), image.name]);
  return [...test.messages, ...[...names].map(([reason, images]) => `${images.join(", ")}: ${reason}`)];
}

/** Of an image that passes; beside the page where it did not fit. */
function smallPicture(image, report, attributes) {
  const picture = element("img", { ...attributes, loading: "lazy" });
  if (image.shown.picture !== null) picture.src = pngAddress(image.shown.picture);
  else if (!isServed) picture.src = addressOf(report, image.pictures.test);
  else
    pictureAddress(report, image.pictures.test).then(
      (address) => (picture.src = address),
      (error) => (picture.alt = error.message),
    );
  return picture;
}

/** What the line of a closed case shows. */
function thumbnailOf(test, report) {
  const image = test.images.find((one) => one.pictures.test);
  if (!image) return element("span", { class: "thumbnail" });
  return smallPicture(image, report, { class: "thumbnail", alt: "" });
}

function caseDetails(test, report, viewers) {
  return element(
    "div",
    { class: "details" },
    test.approve ? commandLine(test.approve.endsWith(" --add") ? "Keep this machine's image" : "Approve", test.approve) : null,
    commandLine("Run again", test.rerun),
    test.images.map((image) => imageSection(image, report, viewers)),
    facts([
      ["Defined in", test.file],
      ["Look", test.look],
      ["Capture", test.capture],
      ["Frames", test.frames],
      ["Set", test.set.join(", ")],
      ["Tags", test.tags.join(", ")],
      ["Hash of look and effects", test.look_hash],
    ]),
    test.steps
      ? element(
          "details",
          { class: "steps" },
          element("summary", {}, "Steps"),
          element("pre", {}, JSON.stringify(test.steps, null, 2)),
        )
      : null,
  );
}

/** One that cannot be shown does not take the others away. */
function safeCaseCard(test, report, viewers) {
  try {
    return caseCard(test, report, viewers);
  } catch (error) {
    return element(
      "details",
      { class: `case ${kindOf(test)}`, id: `case-${test.name}`, "data-kind": kindOf(test), open: true },
      element("summary", {}, element("h2", {}, test.name), verdictMark(test.verdict)),
      element("p", { class: "missing" }, `This case cannot be shown: ${error.message}; report.json has its figures.`),
    );
  }
}

/** Builds what it shows when it is opened first. */
function caseCard(test, report, viewers) {
  const kind = kindOf(test),
    reasons = reasonsOf(test),
    differs = kind === "passed" && test.images.some((image) => !image.bits_equal);
  const card = element(
    "details",
    { class: `case ${kind}`, id: `case-${test.name}`, "data-kind": kind },
    element(
      "summary",
      {},
      kind === "passed" ? thumbnailOf(test, report) : null,
      element("h2", {}, test.name),
      verdictMark(kind === "skipped" ? "skipped" : test.verdict),
      element("span", { class: "quiet" }, seconds(test.seconds) + (differs ? ", within tolerance, bits differ" : "")),
    ),
    kind === "skipped" ? element("p", { class: "reasons" }, test.skipped) : null,
    reasons.length
      ? element(
          "ul",
          { class: "reasons" },
          reasons.map((reason) => element("li", {}, reason)),
        )
      : null,
  );
  const build = () => {
    if (!card.open || card.built) return;
    card.built = true;
    card.append(caseDetails(test, report, viewers));
  };
  card.addEventListener("toggle", build);
  if (kind === "failed" || kind === "warned") card.open = true;
  build();
  return card;
}
