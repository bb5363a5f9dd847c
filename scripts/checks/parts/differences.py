"""How far the pictures of a cut run are from those of the uncut one, by the measure of `aftershade check --warmup`: the 99th
percentile of the difference of RGB over the picture's mean. Exits 1 where one is above the limit.

    differences.py CUT UNCUT LIMIT
"""
import pathlib
import sys

import numpy
import OpenEXR


def pixels(path):
    channels = OpenEXR.File(str(path), separate_channels=True).channels()
    return numpy.stack([channels[name].pixels.astype(numpy.float64) for name in "RGB"])


cut, uncut, limit = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), float(sys.argv[3])
names = sorted(path.name for path in uncut.glob("*.exr"))
errors = []
for name in names:
    truth = pixels(uncut / name)
    difference = numpy.abs(pixels(cut / name) - truth)
    errors.append(numpy.percentile(difference, 99) / numpy.abs(truth).mean())
same = sum(error == 0 for error in errors)
print(f"largest error {max(errors):.2g}, declared {limit:g}; {same} of {len(names)} pictures without any at that percentile")
sys.exit(int(max(errors) > limit))
