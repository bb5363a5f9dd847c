"""Runs the one job of a GitHub workflow in a container as actions/runner does: each `run` is a script of its own for `sh -e`
(a container's default; no pipefail), as root, in a workspace that belongs to the runner's user, who is another. Public actions
are replaced by what they do there; the steps of this tree's own, ci/action.yml, are run."""

import os
import re
from pathlib import Path

import yaml
from container import BRANCH, Container, Failed, copy
from recipe import Unknown, known

RUNNER_UID = 1001
HOME = "/github/home"
SCRIPTS = "/__w/_temp"
ACTION = "/__w/_actions/OWNER/aftershade/TAG/ci"
OWN_ACTION = Path(__file__).resolve().parents[4] / "ci"
SHELLS = {None: ["sh", "-e"], "sh": ["sh", "-e"], "bash": ["bash", "--noprofile", "--norc", "-e", "-o", "pipefail"]}
EXPRESSION = re.compile(r"\$\{\{ (.*?) \}\}")


class GithubJob:
    def __init__(self, recipe, root, url, services, commit, store):
        # YAML 1.1 reads the key `on` as true.
        known(recipe, ["name", True, "jobs", "permissions"], "workflow")
        if len(recipe["jobs"]) != 1:
            raise Unknown("more than one job")
        self.job = known(next(iter(recipe["jobs"].values())), ["runs-on", "container", "steps"], "job")
        if not re.fullmatch("debian:1[23]", self.job["container"]):
            raise Unknown(f"container: {self.job['container']}: only debian:12 and debian:13 are made")
        self.url, self.services, self.commit, self.store = url, services, commit, store
        workspace = "/__w/user/user"
        self.container = Container(root, workspace, {
            "HOME": HOME, "CI": "true", "GITHUB_ACTIONS": "true", "GITHUB_WORKSPACE": workspace, "GITHUB_SHA": commit,
            "GITHUB_HEAD_REF": BRANCH, "GITHUB_REF": "refs/pull/7/merge", "GITHUB_RUN_ID": "1", "GITHUB_REPOSITORY": "user/user",
            "GITHUB_SERVER_URL": "https://github.example", "GITHUB_API_URL": f"{services}/github",
            "GITHUB_STEP_SUMMARY": f"{SCRIPTS}/summary.md"})
        for path in (workspace, HOME, SCRIPTS):
            self.container.at(path).mkdir(parents=True, exist_ok=True)
            # The folders come from the host, the user of the container is root.
            for folder in (self.container.at(path), self.container.at(path).parent):
                folder.chmod(0o755)
                os.chown(folder, RUNNER_UID, RUNNER_UID)
        self.to_cache = []
        self.context = {"github.token": "a-token", "github.run_id": "1"}

    def run(self):
        self.run_steps(self.job["steps"], "step")
        for source, target in self.to_cache:
            copy(source, target)

    def run_steps(self, steps, name):
        failure = None
        for number, step in enumerate(steps, 1):
            place = f"{name}-{number}"
            known(step, ["name", "run", "uses", "with", "if", "env", "shell"], place)
            if step.get("if", "success()") not in ("success()", "always()"):
                raise Unknown(f"{place}: if: {step['if']}")
            if failure and step.get("if") != "always()":
                continue
            print(f"## {step.get('run') or step['uses']}", flush=True)
            try:
                self.run_script(place, step) if "run" in step else self.run_action(place, step)
            except Failed as error:
                print(f"## {place} failed: {error}", flush=True)
                failure = failure or error
        if failure:
            raise failure

    def run_script(self, place, step):
        script = f"{SCRIPTS}/{place}.sh"
        self.container.at(script).write_text(self.expanded(step["run"]))
        environment = {name: self.expanded(value) for name, value in step.get("env", {}).items()}
        code = self.container.run([*SHELLS[step.get("shell")], script], environment)
        if code != 0:
            raise Failed(f"exit code {code}")

    def run_action(self, place, step):
        actions = {"actions/checkout@v4": self.checkout, "actions/cache@v4": self.cache,
                   "actions/upload-artifact@v4": self.upload_artifact}
        options = {name: self.expanded(value) if isinstance(value, str) else value for name, value in step.get("with", {}).items()}
        if step["uses"] == "OWNER/aftershade/ci@TAG":
            self.own_action(place, options)
        elif step["uses"] in actions:
            actions[step["uses"]](options)
        else:
            raise Unknown(f"uses: {step['uses']}")

    def own_action(self, place, options):
        action = yaml.safe_load((OWN_ACTION / "action.yml").read_text())
        known(options, action["inputs"], "inputs")
        self.context.update({f"inputs.{name}": options.get(name, value["default"]) for name, value in action["inputs"].items()})
        copy(OWN_ACTION, self.container.at(ACTION))
        self.container.environment["GITHUB_ACTION_PATH"] = ACTION
        self.run_steps(known(action["runs"], ["using", "steps"], "runs")["steps"], place)

    def checkout(self, options):
        has_lfs = known(options, ["lfs"], "checkout").get("lfs", False)
        for package in ("git", "ca-certificates", *(["git-lfs"] if has_lfs else [])):
            if not self.container.has_package(package):
                raise Failed(f"checkout: without {package} in the container there is no repository, or no file of LFS")
        # Trusted only in a home of its own, which ends with the action.
        own_home = {"HOME": f"{SCRIPTS}/checkout"}
        self.container.at(own_home["HOME"]).mkdir()

        def git(*words):
            self.container.must(["git", *words], own_home)

        git("config", "--global", "--add", "safe.directory", self.container.workspace)
        git("init", "--quiet", self.container.workspace)
        git("remote", "add", "origin", self.url)
        git("fetch", "--quiet", "--no-tags", "--depth=1", "origin", f"+{self.commit}:refs/remotes/origin/main")
        if has_lfs:
            git("config", "lfs.url", f"{self.services}/lfs")  # on GitHub that of the repository itself
            git("lfs", "install", "--local")
            git("lfs", "fetch", "origin", "refs/remotes/origin/main")
        git("checkout", "--quiet", "--force", "-B", "main", "refs/remotes/origin/main")

    def cache(self, options):
        """Found by the key or what it begins with; kept by its key where the job ends well."""
        known(options, ["path", "key", "restore-keys"], "cache")
        kept = self.store / "cache"
        key = options["key"]
        path = self.container.at(re.sub("^~", HOME, options["path"]))
        words = [key, *options.get("restore-keys", "").split()]
        hits = [file for word in words for file in sorted(kept.glob("*")) if file.name.startswith(word)]
        print(f"## cache {key}: {'restored from ' + hits[0].name if hits else 'nothing kept'}")
        if hits:
            copy(hits[0], path)
        if not hits or hits[0].name != key:
            self.to_cache.append((path, kept / key))

    def upload_artifact(self, options):
        known(options, ["name", "path"], "upload-artifact")
        if self.container.at(options["path"]).exists():
            copy(self.container.at(options["path"]), self.store / "artifacts" / options["path"])

    def expanded(self, text):
        unknown = [word for word in EXPRESSION.findall(text) if word not in self.context]
        if unknown:
            raise Unknown(f"expressions: {', '.join(unknown)}")
        return EXPRESSION.sub(lambda match: self.context[match[1]], text)
