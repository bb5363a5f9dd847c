"""Pages are filled where they say so and nowhere else."""
import contextlib
import io
import os
import pathlib
import re
import tempfile
import unittest

from measure.pages import BLOCK, Page, table
from measure.tree import ROOT

PROSE = "# Page\n\n<!-- made by scripts/quality dof: cost -->\n| a |\n<!-- end -->\nof N^<!-- made by scripts/quality dof: slope -->-1<!-- end -->; more\n"
CALL = re.compile(r'Page\("([a-z-]+\.md)", "([a-z/ -]+)",\s*(\[[^]]*\]|blocks)\)')


class Pages(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "page.md").write_text(PROSE)

    def page(self, *blocks: str) -> Page:
        return Page("page.md", "scripts/quality dof", blocks, self.folder)

    def text(self) -> str:
        return (self.folder / "page.md").read_text()

    def test_replaces_a_block_and_leaves_the_rest(self) -> None:
        with contextlib.redirect_stdout(io.StringIO()):
            self.page("cost", "slope").fill({"cost": table(["b", "c"], [[1, 2]])})
        self.assertEqual(self.text(), PROSE.replace("| a |", "| b | c |\n| --- | --- |\n| 1 | 2 |"))

    def test_replaces_a_figure_within_a_line(self) -> None:
        with contextlib.redirect_stdout(io.StringIO()):
            self.page("cost", "slope").fill({"slope": "-0.5"})
        self.assertEqual(self.text(), PROSE.replace("-->-1<!--", "-->-0.5<!--"))

    def test_runs_the_parts_that_are_asked_for_alone(self) -> None:
        os.environ["PARTS"] = "second"
        self.addCleanup(os.environ.pop, "PARTS")
        with contextlib.redirect_stdout(io.StringIO()):
            self.page("cost", "slope").make({"first": lambda: self.fail("first was not asked for"), "second": lambda: {"slope": "-2"}})
        self.assertEqual(self.text(), PROSE.replace("-->-1<!--", "-->-2<!--"))

    def test_refuses_blocks_that_the_page_has_not(self) -> None:
        with self.assertRaisesRegex(SystemExit, "blocks made by scripts/quality dof: cost, slope; it makes cost"):
            self.page("cost")
        with self.assertRaisesRegex(SystemExit, "no block 'price'"):
            self.page("cost", "slope").fill({"price": "1"})

    def test_refills_every_page_with_the_same_bytes(self) -> None:
        count = 0
        for path in sorted((ROOT / "docs").glob("*.md")):
            text = path.read_text(encoding="utf8")
            for maker in {match[2] for match in BLOCK.finditer(text)}:
                (self.folder / path.name).write_text(text, encoding="utf8")
                names = [match[3] for match in BLOCK.finditer(text) if match[2] == maker]
                page = Page(path.name, maker, names, self.folder)
                with contextlib.redirect_stdout(io.StringIO()):
                    page.fill(page.blocks())
                self.assertEqual((self.folder / path.name).read_text(encoding="utf8"), text, f"{path.name}, {maker}")
                count += len(names)
        self.assertGreater(count, 45)

    def test_has_the_blocks_that_each_module_makes(self) -> None:
        made = set()
        for source in [*ROOT.glob("scripts/measure/*.py"), *ROOT.glob("tests/bench/*.py")]:
            text = source.read_text(encoding="utf8")
            for name, maker, blocks in CALL.findall(text):
                listed = re.findall(r"blocks = (\[[^]]*\])", text)[0] if blocks == "blocks" else blocks
                Page(name, maker, re.findall(r'"([a-z-]+)"', listed))
                made.add((name, maker))
        present = {(path.name, match[2]) for path in (ROOT / "docs").glob("*.md") for match in BLOCK.finditer(path.read_text(encoding="utf8"))}
        self.assertEqual(made, present)


if __name__ == "__main__":
    unittest.main()
