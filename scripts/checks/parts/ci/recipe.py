"""The recipes of docs/golden.md, as they are printed there.

    recipe.py DOCUMENT FOLDER [WORD=TEXT...]     writes FOLDER/github.yml, gitlab.yml, Jenkinsfile and shell.sh, with each WORD replaced
"""

import re
import sys
from pathlib import Path

import yaml


class Unknown(Exception):
    """The recipe says what these scripts do not do: then nothing is proven."""


def recipes_in(markdown):
    """{"github.yml": text, ...} of the section "In CI"."""
    section = re.search(r"^## In CI\n(.*?)(?=^## |\Z)", markdown, re.MULTILINE | re.DOTALL)
    if not section:
        raise Unknown('no section "In CI"')
    blocks = re.findall(r"^```(\w+)\n(.*?)^```$", section.group(1), re.MULTILINE | re.DOTALL)

    def name_of(kind, text):
        if kind == "yaml":
            return "github.yml" if "jobs" in yaml.safe_load(text) else "gitlab.yml"
        return {"groovy": "Jenkinsfile", "sh": "shell.sh"}[kind]

    found = {name_of(kind, text): text for kind, text in blocks}
    if len(blocks) != 4 or len(found) != 4:
        raise Unknown(f'"In CI" has {len(blocks)} blocks; one of GitHub, GitLab, Jenkins and the shell each was expected')
    return found


def known(mapping, keys, where):
    """The mapping, all of whose keys are among these."""
    unknown = sorted(str(key) for key in set(mapping) - set(keys))
    if unknown:
        raise Unknown(f"{where}: {', '.join(unknown)}: not known to scripts/checks/parts/ci")
    return mapping


def main():
    document, folder, *words = sys.argv[1:]
    for name, text in recipes_in(Path(document).read_text()).items():
        for word in words:
            before, after = word.split("=", 1)
            text = text.replace(before, after)
        (Path(folder) / name).write_text(text)


if __name__ == "__main__":
    main()
