"""matplotlib without a display, and files that are the same bytes for the same figures."""
import pathlib

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "aftershade"
from matplotlib import pyplot  # noqa: E402  (after the choice of what draws)

__all__ = ["pyplot", "save_plot"]


def save_plot(figure: pyplot.Figure, path: pathlib.Path) -> None:
    if not figure.get_constrained_layout():
        figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})
    pyplot.close(figure)
