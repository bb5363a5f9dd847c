"""Runs the job of a recipe in a chroot.

    run_job.py RECIPE.yml ROOT URL COMMIT STORE

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
from recipe import Unknown


def main():
    recipe, root, url, commit, store = sys.argv[1:]
    document = yaml.safe_load(Path(recipe).read_text())
    shutil.rmtree(Path(store) / "artifacts", ignore_errors=True)
    try:
        (GithubJob if "jobs" in document else GitlabJob)(document, root, url, commit, Path(store)).run()
    except Failed as failure:
        print(f"## job failed: {failure}")
        return 1
    except Unknown as unknown:
        print(f"{recipe}: {unknown}", file=sys.stderr)
        return 2
    print("## job succeeded")
    return 0


sys.exit(main())
