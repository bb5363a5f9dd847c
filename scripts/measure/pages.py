"""Pages of docs/ whose prose is their own and whose figures are measured. What is measured stands between

    <!-- made by scripts/quality dof: cost -->
    <!-- end -->

on lines of their own around a table, or within a line around a figure. Nothing else of a page is ever changed."""
import os
import pathlib
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from measure.tree import ROOT

Rows = list[list[Any]]
Blocks = dict[str, str]  # by name
Figures = dict[str, float]  # of docs/speed.md, by their words there
BLOCK = re.compile(r"(<!-- made by (scripts/[a-z]+(?: [a-z-]+)?|tests/bench/[a-z-]+): ([a-z-]+) -->)(\n?)(.*?)(\n?)(<!-- end -->)", re.S)


def table(head: Sequence[object], rows: Sequence[Sequence[object]]) -> str:
    return "\n".join("| " + " | ".join(map(str, row)) + " |" for row in [head, ["---"] * len(head), *rows])


class Page:
    """One page, and the blocks of it that one command makes."""

    def __init__(self, name: str, maker: str, blocks: Sequence[str], folder: pathlib.Path = ROOT / "docs") -> None:
        self.path, self.maker = folder / name, maker
        # Before anything is measured: that may take an hour.
        if sorted(self.blocks()) != sorted(blocks):
            raise SystemExit(f"{self.path}: blocks made by {maker}: {', '.join(self.blocks()) or 'none'}; it makes {', '.join(blocks)}")

    def blocks(self) -> dict[str, str]:
        found: dict[str, str] = {}
        for match in BLOCK.finditer(self.path.read_text(encoding="utf8")):
            if match[2] == self.maker:
                if match[3] in found:
                    raise SystemExit(f"{self.path}: two blocks '{match[3]}' made by {self.maker}")
                found[match[3]] = match[5]
        return found

    def fill(self, texts: Mapping[str, str]) -> None:
        """Puts each text into its block; the other blocks and all prose stay."""
        if unknown := texts.keys() - self.blocks():
            raise SystemExit(f"{self.path}: no block '{min(unknown)}' made by {self.maker}")

        def filled(match: re.Match[str]) -> str:
            text = texts.get(match[3], match[5]) if match[2] == self.maker else match[5]
            return match[1] + match[4] + text.strip("\n") + match[4] + match[7]

        self.path.write_text(BLOCK.sub(filled, self.path.read_text(encoding="utf8")), encoding="utf8")
        print(f"{self.path.name}: {', '.join(texts)}", flush=True)

    def make(self, parts: Mapping[str, Callable[[], Mapping[str, str]]]) -> None:
        """Runs the parts, or those alone that $PARTS names, and puts what each gives into its blocks at once."""
        wanted = os.environ.get("PARTS", " ".join(parts)).split()
        if unknown := [name for name in wanted if name not in parts]:
            raise SystemExit(f"PARTS: '{unknown[0]}' is not one of {', '.join(parts)}")
        for name in wanted:
            self.fill(parts[name]())
