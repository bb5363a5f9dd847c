"""Runs the one job of a .gitlab-ci.yml as gitlab-runner's docker executor does: a helper container with a git of its own
fetches as root; `before_script` and `script` are one script for bash, which reads it from stdin and takes each line for a
command of its own (errexit and pipefail; what stands before a last && may fail unseen)."""

import os
import shlex
import subprocess

from container import Container, Failed, copy
from recipe import Unknown, known

JOB_KEYS = ["image", "variables", "cache", "before_script", "script", "artifacts"]
ARTIFACT_KEYS = ["when", "expose_as", "paths", "reports"]


class GitlabJob:
    def __init__(self, recipe, root, url, commit, store):
        if len(recipe) != 1:
            raise Unknown("more than one job")
        self.job = known(next(iter(recipe.values())), JOB_KEYS, "job")
        self.cached = known(self.job.get("cache", {}), ["key", "paths"], "cache")
        self.artifacts = known(self.job.get("artifacts", {}), ARTIFACT_KEYS, "artifacts")
        if self.job["image"] != "debian:12":
            raise Unknown(f"image: {self.job['image']}: only debian:12 is made")
        self.url, self.commit, self.store = url, commit, store
        workspace = "/builds/user/user"
        own = {"CI_PROJECT_DIR": workspace}
        self.variables = {name: self.expanded(str(value), own) for name, value in self.job.get("variables", {}).items()}
        self.container = Container(root, workspace, {
            "HOME": "/root", "CI": "true", "GITLAB_CI": "true", "CI_COMMIT_SHA": commit, **own, **self.variables})

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
        """The helper's git, not the image's; it makes what everybody may write."""
        folder = self.container.at(".")
        strategy = self.variables.get("GIT_SUBMODULE_STRATEGY", "none")
        print(f"## fetching, submodules: {strategy}", flush=True)

        def git(*words):
            if subprocess.run(["git", "-C", folder, *words], umask=0).returncode != 0:
                raise Failed(f"git {' '.join(words)}")

        git("init", "--quiet")
        git("remote", "add", "origin", self.url)
        git("fetch", "--quiet", "--no-tags", "--depth=20", "origin", f"+{self.commit}:refs/pipelines/1")
        git("checkout", "--quiet", "--force", "--detach", self.commit)
        if strategy != "none":
            recursive = ["--recursive"] if strategy == "recursive" else []
            git("submodule", "--quiet", "sync", *recursive)
            git("submodule", "--quiet", "update", "--init", "--force", "--depth=20", *recursive)

    def restore(self):
        for path in self.cached.get("paths", []):
            kept = self.store / "cache" / self.cached["key"] / path
            print(f"## cache {path}: {'restored' if kept.exists() else 'nothing kept'}", flush=True)
            if kept.exists():
                copy(kept, self.container.at(path))

    def script(self):
        lines = []
        for line in [*self.job.get("before_script", []), *self.job["script"]]:
            lines += [f"echo {shlex.quote('## ' + line)}", line]
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
