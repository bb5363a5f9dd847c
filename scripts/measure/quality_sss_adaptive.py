"""What sss_adaptive's samples, history, control variates and guiding do over frames, from taps and telemetry: the figures and
pictures of docs/quality-sss-adaptive.md. Scenes and exact sums are made once and kept in build/quality-sss. About 20 minutes, most of
them for the cost at 1080p and 17,000 frames for bias; costs want a quiet machine.

    PARTS="light cost"         these alone, of moving light count guiding bias cycles cost; the others stay as they are
    FRAMES=1000                of each mean for bias
    SIZE=1920x1080             of the cost
    AFTERSHADE=FILE            another executable, and no build
    AFTERSHADE_CAPTURES=DIR    where head lies (docs/measures.md)
"""
from measure.adaptive_bias import FRAMES, bias
from measure.adaptive_cost import COLUMNS, cost
from measure.adaptive_light import AFTER, under_changing_light
from measure.adaptive_moving import first_frames, moving
from measure.adaptive_samples import at_equal_count, on_head, with_taa
from measure.pages import Blocks, Page, table
from measure.sss_techniques import WORK
from measure.tree import ROOT

IMAGES = ROOT / "docs/images/sss"


def light() -> Blocks:
    head = ["control_variate", "samples, peak", "mean", "sampling, ms",
            *(f"{chain}, {when}: dB lost" for chain in AFTER for when in ("first frame", "second"))]
    return {name.replace("_", "-"): table(head, under_changing_light(name, IMAGES)) for name in ("light_toggle", "light_flash")}


def both_biases() -> Blocks:
    unbiased, modes = bias()
    return {"unbiased": table(["controller", "control_variate", "pixels within 3 sigma, %", "mean of the picture, off by", "in sigma"], unbiased),
            "bias": table([f"mean of {FRAMES} frames", "mean of the picture, off by", "root mean square, of pixels", "of that noise"], modes)}


PARTS = {
    "moving": lambda: {
        "moving": table(["", "samples", "default", "fixed", "`guiding` off", "least gain on fixed", "on `guiding` off", "jump",
                         "taa, mean: dB lost", "taa, most: dB lost"], moving()),
        "first": table(["", "`sss_separable`", "frame 1", "frame 16"], first_frames())},
    "light": light,
    "count": lambda: {"count": table(["controller", "samples, mean", "adaptive", "fixed", "ratio"], at_equal_count())},
    "guiding": lambda: {"guiding": table(["", "`taa` alone", "guiding over 19 frames", "ratio", "over 99 frames", "ratio"], with_taa())},
    "bias": both_biases,
    "cycles": lambda: {"cycles": table(["", "samples, mean", "`sss_exact`, dB"], on_head())},
    "cost": lambda: {"cost": table(["", "samples, mean", "PSNR, dB", *(f"{c}, ms" for c in COLUMNS), "all, ms", "times faster"], cost())},
}


def main() -> None:
    page = Page("quality-sss-adaptive.md", "scripts/quality sss-adaptive",
                ["moving", "first", "light-toggle", "light-flash", "count", "guiding", "unbiased", "bias", "cycles", "cost"])
    for folder in WORK, IMAGES:
        folder.mkdir(parents=True, exist_ok=True)
    page.make(PARTS)


if __name__ == "__main__":
    main()
