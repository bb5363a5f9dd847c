"""Makes docs/quality-sss-adaptive.md and its pictures; started by scripts/quality-sss-adaptive, which says what it needs."""
import os

from adaptive_bias import FRAMES, bias
from adaptive_cost import COLUMNS, cost
from adaptive_light import AFTER, under_changing_light
from adaptive_moving import first_frames, moving
from adaptive_samples import at_equal_count, on_head, with_taa
from family import ROOT
from quality import WORK, table

IMAGES = ROOT / "docs/images/sss"
TEXTS = ROOT / "scripts/sss"
# What each word of PARTS makes; the sections of those left out stay as build/quality-sss/adaptive-<word>.md has them.
PARTS = os.environ.get("PARTS", "moving light count guiding bias cycles cost").split()


def light():
    changing = ["control_variate", "samples, peak", "mean", "sampling, ms", *[f"{chain}, {when}: dB lost" for chain in AFTER
                                                                            for when in ("first frame", "second")]]
    return table(changing, under_changing_light("light_toggle", IMAGES)) + "\n" + table(changing, under_changing_light("light_flash", IMAGES))


def both_biases():
    unbiased, modes = bias()
    return (table(["controller", "control_variate", "pixels within 3 sigma, %", "mean of the picture, off by", "in sigma"], unbiased) +
            "\n" + table([f"mean of {FRAMES} frames", "mean of the picture, off by", "root mean square, of pixels", "of that noise"], modes))


def both_motions():
    return (table(["", "samples", "default", "fixed", "`guiding` off", "least gain on fixed", "on `guiding` off", "step"], moving()) + "\n" +
            table(["", "`sss_separable`", "frame 1", "frame 16"], first_frames()))


SECTIONS = {
    "moving": both_motions,
    "light": light,
    "count": lambda: table(["controller", "samples, mean", "adaptive", "fixed", "ratio"], at_equal_count()),
    "guiding": lambda: table(["", "`taa` alone", "guiding over 19 frames", "ratio", "over 99 frames", "ratio"], with_taa()),
    "bias": both_biases,
    "cycles": lambda: table(["", "samples, mean", "`sss_exact`, dB"], on_head()),
    "cost": lambda: table(["", "samples, mean", "PSNR, dB", *[f"{c}, ms" for c in COLUMNS], "all, ms", "times faster"], cost()),
}


def main():
    for folder in WORK, IMAGES:
        folder.mkdir(parents=True, exist_ok=True)
    page = [(TEXTS / "adaptive-head.md").read_text()]
    for name, make in SECTIONS.items():
        kept = WORK / f"adaptive-{name}.md"
        if name in PARTS or not kept.exists():
            kept.write_text(make())
        page.append((TEXTS / f"adaptive-{name}.md").read_text() + "\n" + kept.read_text())
    (ROOT / "docs/quality-sss-adaptive.md").write_text("\n".join(page))


if __name__ == "__main__":
    main()
