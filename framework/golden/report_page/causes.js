// Cases that differ in one way: those that share what changed, a step and the pattern of their differences.

const effectsOf = (test) => [...new Set((test.steps ?? []).map((step) => step.effect ?? step.look).filter(Boolean))];

/**
 * The step that a case's difference most likely comes from: the one that is in most cases that differ and in fewest
 * that do not, by the coefficient of Ochiai (Abreu, Zoeteweij, van Gemund: An Evaluation of Similarity Coefficients for
 * Software Fault Localization, 2006). Where a look's file has the steps, it stands for them.
 */
function suspectedSteps(cases) {
  const differing = cases.filter((test) => !["passed", "skipped"].includes(kindOf(test))),
    passing = cases.filter((test) => kindOf(test) === "passed");
  const count = (list, effect) => list.filter((test) => effectsOf(test).includes(effect)).length;
  const score = (effect) => {
    const failed = count(differing, effect);
    return failed / Math.sqrt(differing.length * (failed + count(passing, effect)));
  };
  const scores = new Map([...new Set(differing.flatMap(effectsOf))].map((effect) => [effect, score(effect)]));
  return (test) => {
    const effects = effectsOf(test);
    if (effects.length === 0) return test.look ?? "no step";
    return effects.reduce((best, effect) => (scores.get(effect) > scores.get(best) ? effect : best));
  };
}

/** The kind of picture that the differences make: in which layers, and in how many pixels. */
function patternOf(test) {
  const images = test.images.filter((image) => !image.bits_equal);
  if (images.length === 0) return "no image was drawn";
  if (images.every((image) => !image.approved)) return "new images";
  const layers = images
    .flatMap((image) => image.comparison?.layers ?? [])
    .filter((layer) => layer.max_error?.value !== 0);
  if (test.verdict === "different size or channels") return "other size or channels";
  const names = [...new Set(layers.map((layer) => layer.layer))].sort().join(", ");
  const percent = Math.max(0, ...layers.map((layer) => layer.failing?.percent ?? 100));
  const share = percent >= 50 ? "most" : percent >= 5 ? "many" : percent > 0 ? "few" : "no";
  return `${share} pixels of ${names || "any layer"} beyond the limit`;
}

/** [{title, cases}], the largest first, of cases that can be approved. */
function causesOf(cases) {
  const stepOf = suspectedSteps(cases),
    causes = new Map();
  for (const test of cases.filter((one) => one.approve)) {
    const changes = [...new Set(test.images.flatMap((image) => image.changes))].sort().join("; ");
    const title = [`${stepOf(test)}: ${patternOf(test)}`, changes].filter(Boolean).join("; ");
    causes.set(title, [...(causes.get(title) ?? []), test]);
  }
  return [...causes].map(([title, list]) => ({ title, cases: list })).sort((a, b) => b.cases.length - a.cases.length);
}
