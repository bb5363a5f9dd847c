"""Runs the one job of a GitHub workflow in a container as actions/runner does: each `run` is a script of its own for `sh -e`
(a container's default; no pipefail), as root, in a workspace that belongs to the runner's user, who is another. The actions
are replaced by what they do there."""

import hashlib
import os
import re

from container import Container, Failed, copy
from recipe import Unknown, known

RUNNER_UID = 1001
HOME = "/github/home"
SCRIPTS = "/__w/_temp"
SHELLS = {None: ["sh", "-e"], "sh": ["sh", "-e"], "bash": ["bash", "--noprofile", "--norc", "-e", "-o", "pipefail"]}


class GithubJob:
    def __init__(self, recipe, root, url, commit, store):
        # YAML 1.1 reads the key `on` as true.
        known(recipe, ["name", True, "jobs", "permissions"], "workflow")
        if len(recipe["jobs"]) != 1:
            raise Unknown("more than one job")
        self.job = known(next(iter(recipe["jobs"].values())), ["runs-on", "container", "env", "steps"], "job")
        if self.job["container"] != "debian:12":
            raise Unknown(f"container: {self.job['container']}: only debian:12 is made")
        self.url, self.commit, self.store = url, commit, store
        workspace = "/__w/user/user"
        self.container = Container(root, workspace, {
            "HOME": HOME, "CI": "true", "GITHUB_ACTIONS": "true", "GITHUB_WORKSPACE": workspace, "GITHUB_SHA": commit,
            **self.job.get("env", {})})
        for path in (workspace, HOME, SCRIPTS):
            self.container.at(path).mkdir(parents=True, exist_ok=True)
            # The folders come from the host, the user of the container is root.
            for folder in (self.container.at(path), self.container.at(path).parent):
                folder.chmod(0o755)
                os.chown(folder, RUNNER_UID, RUNNER_UID)
        self.to_cache = []

    def run(self):
        failure = None
        for number, step in enumerate(self.job["steps"], 1):
            known(step, ["name", "run", "uses", "with", "if", "env", "shell"], f"step {number}")
            if step.get("if", "success()") not in ("success()", "always()"):
                raise Unknown(f"step {number}: if: {step['if']}")
            if failure and step.get("if") != "always()":
                continue
            print(f"## {step.get('run') or step['uses']}", flush=True)
            try:
                self.run_script(number, step) if "run" in step else self.run_action(step)
            except Failed as error:
                print(f"## step {number} failed: {error}", flush=True)
                failure = failure or error
        if failure:
            raise failure
        for source, target in self.to_cache:
            copy(source, target)

    def run_script(self, number, step):
        script = f"{SCRIPTS}/{number}.sh"
        self.container.at(script).write_text(self.expanded(step["run"]))
        code = self.container.run([*SHELLS[step.get("shell")], script], step.get("env"))
        if code != 0:
            raise Failed(f"exit code {code}")

    def run_action(self, step):
        actions = {"actions/checkout@v4": self.checkout, "actions/cache@v4": self.cache,
                   "actions/upload-artifact@v4": self.upload_artifact}
        if step["uses"] not in actions:
            raise Unknown(f"uses: {step['uses']}")
        actions[step["uses"]](step.get("with", {}))

    def checkout(self, options):
        submodules = known(options, ["submodules"], "checkout").get("submodules", False)
        for package in ("git", "ca-certificates"):
            if not self.container.has_package(package):
                raise Failed(f"checkout: without {package} in the container there are no submodules")
        # Trusted only in a home of its own, which ends with the action.
        own_home = {"HOME": f"{SCRIPTS}/checkout"}
        self.container.at(own_home["HOME"]).mkdir()

        def git(*words):
            self.container.must(["git", *words], own_home)

        git("config", "--global", "--add", "safe.directory", self.container.workspace)
        git("init", "--quiet", self.container.workspace)
        git("remote", "add", "origin", self.url)
        git("fetch", "--quiet", "--no-tags", "--no-recurse-submodules", "--depth=1", "origin",
            f"+{self.commit}:refs/remotes/origin/main")
        git("checkout", "--quiet", "--force", "-B", "main", "refs/remotes/origin/main")
        if submodules:
            recursive = ["--recursive"] if submodules == "recursive" else []
            git("submodule", "sync", *recursive)
            git("submodule", "update", "--init", "--force", "--depth=1", *recursive)

    def cache(self, options):
        """Found by the key or what it begins with; kept by its key where the job ends well."""
        known(options, ["path", "key", "restore-keys"], "cache")
        kept = self.store / "cache"
        key = self.expanded(options["key"])
        path = self.container.at(re.sub("^~", HOME, options["path"]))
        words = [key, *options.get("restore-keys", "").split()]
        hits = [file for word in words for file in sorted(kept.glob("*")) if file.name.startswith(word)]
        print(f"## cache {key}: {'restored from ' + hits[0].name if hits else 'nothing kept'}")
        if hits:
            copy(hits[0], path)
        if not hits or hits[0].name != key:
            self.to_cache.append((path, kept / key))

    def upload_artifact(self, options):
        known(options, ["name", "path", "if-no-files-found"], "upload-artifact")
        path = self.container.at(options["path"])
        if path.exists():
            copy(path, self.store / "artifacts" / options["path"])
        elif options.get("if-no-files-found") == "error":
            raise Failed(f"upload-artifact: no {options['path']}")

    def expanded(self, text):
        def hash_of_files(match):
            folder = self.container.at(match[1])
            total = hashlib.sha256()
            for file in sorted(path for path in folder.rglob("*") if path.is_file()):
                total.update(hashlib.sha256(file.read_bytes()).digest())
            return total.hexdigest()

        text = re.sub(r"\$\{\{ hashFiles\('([\w./-]+)/\*\*'\) \}\}", hash_of_files, text)
        if "${{" in text:
            raise Unknown(f"expression in {text}")
        return text
