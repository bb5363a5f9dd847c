"""A job's container (a chroot on Debian) and what a runner keeps between and after jobs."""

import os
import shutil
import subprocess
from pathlib import Path

PATH = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"
# How this machine reaches the package mirror: not the recipe's.
OF_THIS_MACHINE = ("http_proxy", "https_proxy")
# A branch that a job's shell must not take for a command: it would make the file PWNED.
BRANCH = "a$(touch${IFS}PWNED);touch${IFS}PWNED"


class Failed(Exception):
    """What the runner would end the job with."""


class Container:
    def __init__(self, root, workspace, environment):
        self.root = Path(root)
        self.workspace = workspace
        self.environment = {"PATH": PATH, "no_proxy": "127.0.0.1", **environment}
        self.environment.update({name: os.environ[name] for name in OF_THIS_MACHINE if name in os.environ})
        self.at(workspace).mkdir(parents=True)

    def at(self, path):
        """Where a path in the container is outside of it; relative ones are below the workspace."""
        return self.root / (Path(self.workspace) / path).relative_to("/")

    def run(self, command, environment=None, stdin=None):
        """The exit code."""
        variables = [f"{name}={value}" for name, value in {**self.environment, **(environment or {})}.items()]
        inside = ["env", "-i", "-C", self.workspace, *variables, *command]
        text = {"stdin": subprocess.DEVNULL} if stdin is None else {"input": stdin.encode()}
        return subprocess.run(["chroot", self.root, *inside], **text).returncode

    def must(self, command, environment=None):
        code = self.run(command, environment)
        if code != 0:
            raise Failed(f"{' '.join(command)}: exit code {code}")

    def has_package(self, name):
        query = ["chroot", self.root, "dpkg-query", "-W", "-f=${db:Status-Status}", name]
        return subprocess.run(query, capture_output=True, text=True).stdout == "installed"


def copy(source, target):
    """A file, or a folder with what is in it, in the place of what is there."""
    if target.is_dir():
        shutil.rmtree(target)
    target.parent.mkdir(parents=True, exist_ok=True)
    if source.is_dir():
        shutil.copytree(source, target, symlinks=True)
    else:
        shutil.copy2(source, target)
