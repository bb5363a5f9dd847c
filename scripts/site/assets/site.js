// The border of each slider follows its range input, by mouse and keyboard.
for (const input of document.querySelectorAll(".slider input")) {
  const pictures = input.parentElement.querySelector(".slider-pictures");
  input.addEventListener("input", () => pictures.style.setProperty("--at", `${input.value}%`));
}
document.querySelector(".md-search")?.setAttribute("aria-label", "Search");
// Wide tables scroll; Material wraps them when the page has loaded.
const letFocus = () => document.querySelectorAll(".md-typeset__scrollwrap, .md-typeset__table").forEach((wrap) => (wrap.tabIndex = 0));
letFocus();
new MutationObserver(letFocus).observe(document.body, { childList: true, subtree: true });
