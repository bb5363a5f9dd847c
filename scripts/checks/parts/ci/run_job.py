"""Runs the job of a recipe in a chroot.

    run_job.py RECIPE ROOT URL SERVICES COMMIT STORE     SERVICES: URL of server.py

STORE/cache is what jobs keep for the next, STORE/artifacts what this one leaves. Exit code: 0 the job is green, 1 it is red,
2 the recipe has what is not known here.
"""

import shutil
import sys
from pathlib import Path

import yaml
from container import Failed
from github import GithubJob
from gitlab import GitlabJob
from plain import JenkinsJob, ShellJob
from recipe import Unknown


def main():
    recipe, root, url, services, commit, store = sys.argv[1:]
    text, kind = Path(recipe).read_text(), Path(recipe).name
    document = yaml.safe_load(text) if kind.endswith(".yml") else text
    job = {"github.yml": GithubJob, "gitlab.yml": GitlabJob, "Jenkinsfile": JenkinsJob, "shell.sh": ShellJob}[kind]
    shutil.rmtree(Path(store) / "artifacts", ignore_errors=True)
    try:
        job(document, root, url, services, commit, Path(store)).run()
    except Failed as failure:
        print(f"## job failed: {failure}")
        return 1
    except Unknown as unknown:
        print(f"{recipe}: {unknown}", file=sys.stderr)
        return 2
    print("## job succeeded")
    return 0


sys.exit(main())
