"""A Containerfile's steps in a chroot, as podman or docker would run them. Needs dockerfile-parse.

    containerfile.py FILE CONTEXT ROOT [WORD...]     ROOT is a fresh system of the kind that FROM names; WORD... go to
                                                     the entry point in place of CMD

Exit code: the entry point's; 1 where a step fails, 2 where the file has what is not known here.
"""

import json
import re
import shlex
import sys
from pathlib import Path

from container import Container, Failed, copy
from dockerfile_parse import DockerfileParser
from recipe import Unknown

BASE = re.compile(r"(docker\.io/library/)?debian:(12|bookworm)(-slim)?")


def steps_of(file):
    """[(instruction, value)], with continued lines joined and without comments."""
    with open(file, "rb") as text:
        structure = DockerfileParser(fileobj=text).structure
    return [(step["instruction"].upper(), step["value"]) for step in structure if step["instruction"] != "COMMENT"]


def assignments(value):
    words = shlex.split(value)
    if not all("=" in word for word in words):
        raise Unknown(f"{value}: NAME=VALUE was expected")
    return dict(word.split("=", 1) for word in words)


def files_of(pattern, context):
    found = sorted(Path(context).glob(pattern))
    if not found:
        raise Failed(f"COPY {pattern}: no such file in {context}")
    return found


class Build:
    def __init__(self, context, root):
        self.context = context
        self.container = Container(root, "/build", {"HOME": "/root"})
        self.arguments, self.workspace = {}, "/"
        self.entry, self.command = [], []

    def step(self, instruction, value):
        print(f"## {instruction} {value}", flush=True)
        if instruction == "FROM":
            if not BASE.fullmatch(value):
                raise Unknown(f"FROM {value}: only Debian 12 is known here")
        elif instruction == "ARG":
            self.arguments.update(assignments(value))
        elif instruction == "ENV":
            self.container.environment.update(assignments(value))
        elif instruction == "COPY":
            *sources, target = value.split()
            if not target.endswith("/"):
                raise Unknown(f"COPY {value}: a folder was expected, with '/' at its end")
            for source in (one for pattern in sources for one in files_of(pattern, self.context)):
                copy(source, self.container.at(target) / source.name)
        elif instruction == "RUN":
            self.container.must(["/bin/sh", "-c", value], self.arguments)
        elif instruction == "WORKDIR":
            self.workspace = value
            self.container.at(value).mkdir(parents=True, exist_ok=True)
        elif instruction in ("ENTRYPOINT", "CMD"):
            words = json.loads(value)
            if instruction == "CMD":
                self.command = words
            else:
                self.entry = words
        else:
            raise Unknown(f"{instruction}: not known to scripts/checks/parts/ci")

    def start(self, words):
        self.container.workspace = self.workspace
        print("##", shlex.join(self.entry + (words or self.command)), flush=True)
        return self.container.run(self.entry + (words or self.command))


def main():
    file, context, root, *words = sys.argv[1:]
    try:
        build = Build(context, root)
        for instruction, value in steps_of(file):
            build.step(instruction, value)
        return build.start(words)
    except Failed as failure:
        print(f"## failed: {failure}")
        return 1
    except Unknown as unknown:
        print(f"{file}: {unknown}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
