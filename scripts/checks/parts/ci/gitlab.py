"""Runs the one job of a .gitlab-ci.yml, this tree's component, as gitlab-runner's docker executor does: a helper container with a git of its own
fetches as root; `before_script` and `script` are one script for bash, which reads it from stdin and takes each line for a
command of its own (errexit and pipefail; what stands before a last && may fail unseen)."""

import os
import re
import shlex
import subprocess
from pathlib import Path

import yaml
from container import BRANCH, Container, Failed, copy
from recipe import Unknown, known

COMPONENT = Path(__file__).resolve().parents[4] / "templates/golden.yml"
JOB_KEYS = ["image", "variables", "cache", "script", "artifacts"]
ARTIFACT_KEYS = ["when", "expose_as", "paths", "reports"]


def with_inputs(thing, inputs):
    """Every `$[[ inputs.NAME ]]` in the texts of a document; GitLab reads the YAML first."""
    if isinstance(thing, dict):
        return {key: with_inputs(value, inputs) for key, value in thing.items()}
    if isinstance(thing, list):
        return [with_inputs(value, inputs) for value in thing]
    if not isinstance(thing, str):
        return thing
    return re.sub(r"\$\[\[ inputs\.(\w+) \]\]", lambda match: inputs[match[1]], thing)


def component_of(recipe):
    """The jobs that a .gitlab-ci.yml includes."""
    includes = known(recipe, ["include"], "recipe")["include"]
    if len(includes) != 1 or includes[0]["component"] != "$CI_SERVER_FQDN/OWNER/aftershade/golden@TAG":
        raise Unknown(f"include: {includes}")
    given = known(includes[0], ["component", "inputs"], "include").get("inputs", {})
    head, jobs = yaml.safe_load_all(COMPONENT.read_text())
    specified = head["spec"]["inputs"]
    known(given, specified, "inputs")
    return with_inputs(jobs, {name: given.get(name, value["default"]) for name, value in specified.items()})


class GitlabJob:
    def __init__(self, recipe, root, url, services, commit, store):
        recipe = component_of(recipe)
        if len(recipe) != 1:
            raise Unknown("more than one job")
        self.job = known(next(iter(recipe.values())), JOB_KEYS, "job")
        self.cached = known(self.job.get("cache", {}), ["key", "paths"], "cache")
        self.artifacts = known(self.job.get("artifacts", {}), ARTIFACT_KEYS, "artifacts")
        image = known(self.job["image"], ["name", "entrypoint"], "image")
        if not re.fullmatch("debian:1[23]", image["name"]) or image["entrypoint"] != [""]:
            raise Unknown(f"image: {image}: only debian:12 and debian:13 are made")
        self.url, self.commit, self.store = url, commit, store
        workspace = "/builds/user/user"
        own = {"CI_PROJECT_DIR": workspace, "CI_JOB_TOKEN": "secret"}
        self.variables = {name: value["value"] if isinstance(value, dict) and value["expand"] is False else self.expanded(value, own)
                          for name, value in self.job.get("variables", {}).items()}
        self.container = Container(root, workspace, {
            "HOME": "/root", "CI": "true", "GITLAB_CI": "true", "CI_COMMIT_SHA": commit, "CI_COMMIT_REF_NAME": BRANCH,
            "CI_API_V4_URL": f"{services}/gitlab", "CI_PROJECT_ID": "1", "CI_MERGE_REQUEST_IID": "7", "GOLDEN_TOKEN": "a-token",
            "CI_JOB_URL": "https://gitlab.example/user/user/-/jobs/1", **own, **self.variables})

    @staticmethod
    def expanded(text, variables):
        for name, value in variables.items():
            text = text.replace(f"${name}", value)
        if "$" in text:
            raise Unknown(f"variable in {text}")
        return text

    def run(self):
        self.fetch()
        self.restore()
        failure = None
        code = self.container.run(["bash"], stdin=self.script())
        if code != 0:
            failure = Failed(f"exit code {code}")
        else:
            for path in self.cached.get("paths", []):
                copy(self.container.at(path), self.store / "cache" / self.cached["key"] / path)
        self.upload(failure)
        if failure:
            raise failure

    def fetch(self):
        """The helper's git, not the image's; it makes what everybody may write. One without git-lfs: files of LFS are pointers."""
        folder = self.container.at(".")
        print("## fetching", flush=True)

        def git(*words):
            if subprocess.run(["git", "-C", folder, *words], umask=0).returncode != 0:
                raise Failed(f"git {' '.join(words)}")

        git("init", "--quiet")
        git("remote", "add", "origin", self.url)
        git("fetch", "--quiet", "--no-tags", "--depth=20", "origin", f"+{self.commit}:refs/pipelines/1")
        git("checkout", "--quiet", "--force", "--detach", self.commit)

    def restore(self):
        for path in self.cached.get("paths", []):
            kept = self.store / "cache" / self.cached["key"] / path
            print(f"## cache {path}: {'restored' if kept.exists() else 'nothing kept'}", flush=True)
            if kept.exists():
                copy(kept, self.container.at(path))

    def script(self):
        lines = []
        for line in self.job["script"]:
            lines += [f"echo {shlex.quote('## ' + line.splitlines()[0])}", line]
        body = "\n".join([f"cd {self.container.workspace}", *lines]) + "\n"
        return f"set -eo pipefail\nset +o noclobber\n: | eval {shlex.quote(body)}\nexit 0\n"

    def upload(self, failure):
        when = self.artifacts.get("when", "on_success")
        if when != "always" and (when == "on_failure") != bool(failure):
            return
        paths = self.artifacts.get("paths", [])
        if "expose_as" in self.artifacts and not any(self.is_exposed(path) for path in paths):
            print("## expose_as: nothing is shown; a folder is named with its last /")
        for path in [*paths, *known(self.artifacts.get("reports", {}), ["junit"], "reports").values()]:
            if self.container.at(path).exists():
                copy(self.container.at(path), self.store / "artifacts" / path)
            else:
                print(f"## artifacts: no {path}")

    def is_exposed(self, path):
        inside = self.container.at(path)
        return path.endswith("/") if inside.is_dir() else os.path.exists(inside)
