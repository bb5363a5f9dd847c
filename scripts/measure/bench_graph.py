"""What the frame graph costs: 16 copies of 1920x1080 through the executor against the same draws by GL alone, in one process and in
turns, so that the machine's noise meets both alike. Exits 1 where the ratio of the medians exceeds 1.10.

    REPETITIONS=15
"""
import json
import os
import statistics
import sys

from measure.tree import ROOT, command


def main() -> None:
    told = command([ROOT / "build/release/tests/bench/graph_bench", f"--benchmark_repetitions={os.environ.get('REPETITIONS', '15')}",
                    "--benchmark_min_time=0.05", "--benchmark_enable_random_interleaving=true", "--benchmark_format=json"])
    times: dict[str, dict[str, list[float]]] = {}
    for run in json.loads(told)["benchmarks"]:
        if run.get("error_occurred"):
            sys.exit(f"{run['name']}: {run['error_message']}")
        if run["run_type"] == "iteration":
            name, size = run["run_name"].removesuffix("/real_time").split("/", 1)
            times.setdefault(size, {}).setdefault(name, []).append(run["real_time"])
    for size, by_name in times.items():
        executor, bare = (statistics.median(by_name[n]) for n in ("through_the_executor", "in_a_bare_loop"))
        ratio = executor / bare
        print(f"{size.replace('/', 'x'):>10}: executor {executor:.3f} ms, bare loop {bare:.3f} ms, ratio {ratio:.3f}")
        if size == "1920/1080" and ratio > 1.10:
            sys.exit("the executor costs more than 1.10 times the bare loop")


if __name__ == "__main__":
    main()
