"""Sentences of pages: their places, their lengths in words, and constructions that docs/writing.md does without."""
import dataclasses
import itertools
import pathlib
import re
from collections.abc import Iterator

FENCE = re.compile(r"^(```|~~~).*?^\1[^\n]*$", re.M | re.S)
COMMENT = re.compile(r"<!--.*?-->", re.S)
CODE = re.compile(r"(`+)(.+?)\1", re.S)
LINK = re.compile(r"!?\[([^\]]*)\](?:\([^)]*\)|\[[^\]]*\])")
TAG = re.compile(r"<[a-z/][^>]*>")
QUOTED = re.compile(r"^- Before: .*$", re.M)  # docs/writing.md shows what not to write
LIST_ITEM = re.compile(r"\s*(?:[-*]|\d+\.)\s+")
CELLS = re.compile(r"(?<!\\)\|")
# A sentence ends where a capital, a digit, code or a bracket follows the mark.
END = re.compile(r"(?<!\be\.g)(?<!\bi\.e)(?<!\bal)(?<!\b[A-Z])([.!?][)\"*_]*)\s+(?=[A-Z0-9\"(`*_\[]|[\w-]+[.](?:md|h|json)\b|llvmpipe|idiff)")
# In declarations, "value: what it means." and "; value: what it means." are entries of a list.
ENTRY = re.compile(r"([.;:])\s+(?=[a-z][a-z0-9_]*: )")
WORD = re.compile(r"[A-Za-z0-9][\w'’./+-]*|`")

ALLOWED = "scripts/measure/prose_allowed.txt"
MEAN_WORDS = 18
MOST_WORDS = 35

NOT_QUESTION = r"(?!.*\?)"
RULES = [
    ("relative clause as the subject: name the thing", NOT_QUESTION + r"^(What|Whatever|Whoever|Where what|How much of it)\b[^:]*?\b\w+"),
    ("label without its noun: name what it is of", r"^Of (the|its|their|a|an|all|each|what|one)\b"),
    ("'but for': write except", r"\bbut for\b"),
    ("'but' as except: write except or only", r"\b(nothing|anything|everything|no \w+|all|every role) but\b"),
    ("'before it', 'behind it' in place of else: put the condition first", r"; before it\b"),
    ("verb before its subject", r"^(In|On|At|Behind|Beside|Below|Above|There|Here|Then) (?:\w+ ){0,5}(stands?|lies?|goe?s?|comes?) "
     r"(?!(in|to|from|first|last|by|before|after|outside|below|above|beside|within)\b)"),
    ("'what' after a preposition: name the thing", r"\b(in|of|from|behind|by|over|under|with|for|to|at|beside|through) what\b"),
    ("'whatever': write for any, or of any", r"\bwhatever\b"),
    ("'where there is': write if", r"\bwhere there (is|are)\b"),
    ("'held to', 'held against': write compared with", r"\bheld (to|against)\b"),
    ("'nothing but': write only", r"\bnothing but\b"),
    ("'hangs on': write depends on", r"\b(hangs?|hung) on\b"),
    ("'begins again': write restarts", r"\bbegins? again\b|\bbegins? afresh\b"),
    ("'otherwise' as an adjective: say how", r"\b(One object|what is) otherwise\b"),
    ("'what is to go': write deprecated", r"\bis to go\b"),
    ("'takes ... for': write reads ... as", r"\btakes? (it|them|that|this) for\b"),
    ("'as ever', 'all the same': write also then", r"\bas ever\b|\ball the same\b"),
    ("'the one that ... has': name the value", r"\bthe most that\b|\bthe fewest that\b"),
    ("'wants' of a thing: write needs", r"\b(it|that|which|one|model|skin) (usually )?wants\b"),
    ("'by it' at the end: name the thing", r"\b(by|for) it[.]$"),
]
COMPILED = [(name, re.compile(pattern, re.I if pattern.startswith(r"\b") else 0)) for name, pattern in RULES]


@dataclasses.dataclass(frozen=True)
class Sentence:
    line: int
    text: str
    is_cell: bool

    @property
    def words(self) -> int:
        return len(WORD.findall(self.text))

    def words_apart(self) -> str:
        """Each piece of code as a word of its own, so that two in a row are not the same word twice."""
        numbers = itertools.count()
        return re.sub("`", lambda _: f"code{next(numbers)}", self.text)

    def faults(self) -> list[str]:
        found = [name for name, pattern in COMPILED if pattern.search(self.text)]
        if self.words > MOST_WORDS:
            found.append(f"{self.words} words: at most {MOST_WORDS}")
        return found


def plain(text: str) -> str:
    """The words of Markdown: code is one word, a link its text."""
    text = CODE.sub("`", LINK.sub(lambda m: m[1], text)).replace("`", " ` ")
    return re.sub(r"\s+", " ", TAG.sub(" ", text)).replace(" ` ,", " `,").strip(" *|")


def blank(pattern: re.Pattern[str], text: str) -> str:
    """Without what matches; the lines stay."""
    return pattern.sub(lambda m: "\n" * m[0].count("\n"), text)


def blocks(page: str) -> Iterator[tuple[int, str, bool]]:
    """(line, text, is a table's cell) of each paragraph, list item and cell; code and headings are left out."""
    gathered: list[str] = []
    start = 0
    for number, line in enumerate((blank(COMMENT, blank(FENCE, QUOTED.sub("", page))) + "\n\n").split("\n"), 1):
        item = LIST_ITEM.match(line)
        is_code = line.startswith("    ") and not gathered and not item
        if gathered and (not line.strip() or item or line.startswith(("|", "#"))):
            yield start, " ".join(gathered), False
            gathered = []
        if line.startswith("|"):
            yield from ((number, cell, True) for cell in CELLS.split(line) if re.search("[A-Za-z]", cell))
        elif line.strip() and not line.startswith("#") and not is_code:
            start = start if gathered else number
            gathered.append(line[item.end():] if item else line.strip())


def sentences(page: str) -> list[Sentence]:
    found = []
    for line, text, is_cell in blocks(page):
        at = 0
        words = ENTRY.sub(r". `", plain(text))
        for end in [*END.finditer(words), None]:
            sentence = words[at:end.end(1) if end else len(words)].strip(" *")
            if WORD.search(sentence):
                found.append(Sentence(line, sentence, is_cell))
            at = end.end() if end else at
    return found


class Allowed:
    """Lines "page: beginning of the sentence # reason"; a beginning "*" stands for all sentences of the page."""

    def __init__(self, root: pathlib.Path) -> None:
        lines = (root / ALLOWED).read_text(encoding="utf8").splitlines()
        self.entries = [line.rpartition(" # ")[0].strip() for line in lines if " # " in line and not line.startswith("#")]
        self.used: set[str] = set()

    def covers(self, page: str, sentence: str) -> bool:
        found = [entry for entry in self.entries
                 if entry == f"{page}: *" or entry.startswith(f"{page}: ") and sentence.startswith(entry[len(page) + 2:])]
        self.used.update(found)
        return bool(found)

    def unused(self) -> list[str]:
        return [entry for entry in self.entries if entry not in self.used]


def pages(root: pathlib.Path) -> list[pathlib.Path]:
    """What users read; effects' pages are made from manifests, so that their docs are checked too."""
    return [root / "README.md", root / "CONTRIBUTING.md", root / "SECURITY.md", *sorted((root / "docs").glob("*.md")),
            *sorted((root / "docs/effects").glob("*.md"))]
