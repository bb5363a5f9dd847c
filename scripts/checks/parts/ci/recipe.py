"""The recipes of docs/golden.md, as they are printed there.

    recipe.py DOCUMENT FOLDER     writes FOLDER/github.yml and FOLDER/gitlab.yml
"""

import re
import sys
from pathlib import Path

import yaml


class Unknown(Exception):
    """The recipe says what these scripts do not do: then nothing is proven."""


def recipes_in(markdown):
    """{"github": text, "gitlab": text} of the section "In CI"."""
    section = re.search(r"^## In CI\n(.*?)(?=^## |\Z)", markdown, re.MULTILINE | re.DOTALL)
    if not section:
        raise Unknown('no section "In CI"')
    texts = re.findall(r"^```yaml\n(.*?)^```$", section.group(1), re.MULTILINE | re.DOTALL)
    found = {"github" if "jobs" in yaml.safe_load(text) else "gitlab": text for text in texts}
    if len(texts) != 2 or len(found) != 2:
        raise Unknown(f'"In CI" has {len(texts)} yaml blocks; one of GitHub and one of GitLab were expected')
    return found


def known(mapping, keys, where):
    """The mapping, all of whose keys are among these."""
    unknown = sorted(str(key) for key in set(mapping) - set(keys))
    if unknown:
        raise Unknown(f"{where}: {', '.join(unknown)}: not known to scripts/checks/parts/ci")
    return mapping


def main():
    for name, text in recipes_in(Path(sys.argv[1]).read_text()).items():
        (Path(sys.argv[2]) / f"{name}.yml").write_text(text)


if __name__ == "__main__":
    main()
