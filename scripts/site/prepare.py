"""Writes what mkdocs reads: docs/ with the pages of the repository's root, in the dialect of Python-Markdown.

usage: prepare.py FOLDER
"""
import html
import pathlib
import re
import shutil
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
ROOT_PAGES = {"README.md": "readme.md", "CONTRIBUTING.md": "contributing.md", "STYLE.md": "style.md", "SECURITY.md": "security.md"}
LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)\s]+)\)")
LIST_ITEM = re.compile(r"\s*(-|\d+\.) ")
PICTURE = re.compile(r"!\[([^\]]*)\]\(([^)\s]+)\)")


def target(link: str, page: pathlib.Path) -> str | None:
    """The link as the site has it; None where it leads to a file that is not on the site."""
    if re.match(r"[a-z]+:|#", link):
        return link
    name, _, anchor = link.partition("#")
    path = (page.parent / name).resolve().relative_to(ROOT)
    anchor = "#" + anchor if anchor else ""
    if str(path) in ROOT_PAGES:
        found = ROOT_PAGES[str(path)]
    elif path.parts[0] == "docs" and (ROOT / path).exists():
        found = str(path.relative_to("docs"))
    else:
        if not (ROOT / path).exists():
            raise SystemExit(f"{page}: no file {name}")
        return None
    depth = len(page.relative_to(ROOT / "docs").parts) - 1 if page.is_relative_to(ROOT / "docs") else 0
    return "../" * depth + found + anchor


def with_links(line: str, page: pathlib.Path) -> str:
    def replaced(match: re.Match) -> str:
        link = target(match[3], page)
        return match[2] if link is None else f"{match[1]}[{match[2]}]({link})"

    return LINK.sub(replaced, line)


def slider(rows: list[str]) -> str:
    """A table of pictures as a slider between its first and its last one."""
    cells = [cell for row in rows for cell in row.strip("|").split("|")]
    pictures = [match for cell in cells if (match := PICTURE.search(cell))]
    first, last = pictures[0], pictures[-1]
    return (
        f'<figure class="slider"><div class="slider-pictures" style="--at: 50%">'
        f'<img src="{html.escape(last[2])}" alt="{html.escape(last[1])}">'
        f'<img class="slider-over" src="{html.escape(first[2])}" alt="{html.escape(first[1])}"></div>'
        f'<input type="range" min="0" max="100" value="50" aria-label="Position of the border between: '
        f'{html.escape(first[1])} (left) and {html.escape(last[1])} (right)">'
        f"<figcaption>Left: {html.escape(first[1])}. Right: {html.escape(last[1])}.</figcaption></figure>"
    )


def converted(text: str, page: pathlib.Path) -> str:
    """Blank lines where GitHub needs none, nested lists by four spaces, links of the site, sliders."""
    lines, fence, before, table, is_slider = [], None, "", [], False
    for line in text.splitlines() + [""]:
        if fence:
            fence = None if line.strip() == fence else fence
        elif match := re.match(r"\s*(```+)", line):
            fence = match[1]
        elif not line.startswith("    ") or LIST_ITEM.match(line):
            line = with_links(line, page)
            if is_slider and line.startswith("|"):
                table.append(line)
                before = line
                continue
            if table:
                lines += ["", slider(table), ""]
                table, is_slider = [], False
            if line.strip() == "<!-- slider -->":
                is_slider = True
                continue
            is_item, was_item = bool(LIST_ITEM.match(line)), bool(LIST_ITEM.match(before)) or before.startswith("  ")
            starts = is_item and before.strip() and not was_item
            borders = line.startswith("|") != before.startswith("|") and line.strip() and before.strip()
            if starts or borders or line.startswith("<!--") or before.startswith("<!--"):
                lines.append("")
            if is_item and len(line) - len(line.lstrip()) in (2, 3):
                line = "    " + line.lstrip()
        lines.append(line)
        before = line
    return "\n".join(lines) + "\n"


def main() -> None:
    folder = pathlib.Path(sys.argv[1])
    source = folder / "source"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(ROOT / "docs", source)
    for page in (ROOT / "docs").glob("**/*.md"):
        (source / page.relative_to(ROOT / "docs")).write_text(converted(page.read_text(encoding="utf8"), page), encoding="utf8")
    for name, place in ROOT_PAGES.items():
        page = ROOT / name
        (source / place).write_text(converted(page.read_text(encoding="utf8"), page), encoding="utf8")
    shutil.copytree(HERE / "assets", source / "assets")
    shutil.copy(HERE / "hooks.py", folder)
    effects = sorted(page.name for page in (ROOT / "docs/effects").glob("*.md") if page.name != "README.md")
    config = (HERE / "mkdocs.yml").read_text(encoding="utf8")
    (folder / "mkdocs.yml").write_text(config.replace("EFFECTS", ", ".join(f"effects/{name}" for name in effects)), encoding="utf8")


if __name__ == "__main__":
    main()
