"""Runs the steps of a Jenkinsfile, and the commands of a plain shell, in a container with the user's repository in its workspace."""

import re
import subprocess

from container import BRANCH, Container, Failed, copy
from recipe import Unknown


class PlainJob:
    """After a checkout without git-lfs, whose files belong to another user than the job's."""

    def __init__(self, scripts, shell, environment, root, url, commit, store):
        self.scripts, self.shell, self.url, self.commit, self.store = scripts, shell, url, commit, store
        self.container = Container(root, "/workspace", {"HOME": "/root", "CI": "true", "BRANCH_NAME": BRANCH, **environment})

    def fetch(self):
        folder = self.container.at(".")
        for words in (["init", "--quiet"], ["fetch", "--quiet", "--depth=1", self.url, self.commit],
                      ["checkout", "--quiet", "--force", "FETCH_HEAD"]):
            if subprocess.run(["git", "-C", folder, *words]).returncode != 0:
                raise Failed(f"git {' '.join(words)}")
        subprocess.run(["chown", "-R", "1000:1000", folder], check=True)

    def run(self):
        """Each script is one of its own. The report is kept whatever the verdict is."""
        self.fetch()
        code = 0
        for script in self.scripts:
            print(f"## {script}", flush=True)
            code = code or self.container.run([*self.shell, script])
        if self.container.at("report").exists():
            copy(self.container.at("report"), self.store / "artifacts/report")
        if code != 0:
            raise Failed(f"exit code {code}")


class JenkinsJob(PlainJob):
    def __init__(self, text, root, url, services, commit, store):
        lines = re.search(r"environment \{\n(.*?)\n    \}", text, re.DOTALL)[1].splitlines()
        variables = [re.fullmatch(r" *(\w+) = '([^']*)'", line) for line in lines]
        if not all(variables):
            raise Unknown("environment: a line is not NAME = 'TEXT'")
        # Groovy takes what is between single quotes as it is.
        super().__init__(re.findall(r"\bsh '([^']*)'", text), ["sh", "-xec"], dict(one.groups() for one in variables), root, url, commit, store)


class ShellJob(PlainJob):
    def __init__(self, text, root, url, services, commit, store):
        # begin() of ci-recipes has copied the packages there.
        super().__init__([text], ["bash", "-ec"], {"GOLDEN_SOURCE": "/packages"}, root, url, commit, store)
