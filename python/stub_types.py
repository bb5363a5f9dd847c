"""Gives the generic types of nanobind's stub their arguments, which mypy --strict demands: stub_types.py IN OUT"""

import pathlib
import re
import sys

TYPES = {
    r"\bos\.PathLike\b(?!\[)": "os.PathLike[str]",
    r"\bdict\b(?![\[(])": "dict[str, Any]",
    r"\blist\b(?!\[)": "list[Any]",
    r"\bNDArray\b(?=[,\]])": "NDArray[Any]",
    r"^from typing import (?!.*\bAny\b)(.*)$": r"from typing import Any, \1",
}

text = pathlib.Path(sys.argv[1]).read_text(encoding="utf8")
for pattern, typed in TYPES.items():
    text = re.sub(pattern, typed, text, flags=re.M)
pathlib.Path(sys.argv[2]).write_text(text, encoding="utf8")
