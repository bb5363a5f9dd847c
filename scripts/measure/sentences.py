"""Sentences of Markdown pages: prose without code, tables' cells one text each, and their lengths in words."""
import dataclasses
import html
import re

FENCE = re.compile(r"^(```|~~~).*?^\1[^\n]*$", re.M | re.S)
MADE = re.compile(r"^<!-- made by .*?^<!-- end -->$", re.M | re.S)
COMMENT = re.compile(r"<!--.*?-->", re.S)
INLINE_CODE = re.compile(r"(`+)(.+?)\1", re.S)
LINK = re.compile(r"!?\[([^\]]*)\]\([^)]*\)")
LIST_ITEM = re.compile(r"^\s*([-*]|\d+\.)\s+")
# What ends a sentence is followed by a capital, a digit, code or a bracket; "e.g." and initials do not end one.
END = re.compile(r"(?<!\be\.g)(?<!\bi\.e)(?<!\bcf)(?<!\bal)(?<!\b[A-Z])[.!?:][)\"*_]*\s+(?=[A-Z0-9\"(`*_\[<])|;\s+")
WORD = re.compile(r"[A-Za-z0-9][\w'./+-]*|`")


@dataclasses.dataclass
class Sentence:
    line: int
    text: str
    words: int
