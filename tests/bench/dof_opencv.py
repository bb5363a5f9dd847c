"""Depth of field as a short script does it with OpenCV: the picture in 16 layers of equal CoC, each blurred by a disk of its radius,
laid over one another from the back. The lens is that of dof_against_blender.py. Run by rivals.py.

    python dof_opencv.py IN.exr OUT.exr
"""
import sys

import cv2
import numpy
import OpenImageIO as oiio

file = oiio.ImageInput.open(sys.argv[1])
names = list(file.spec().channelnames)
first, z = names.index("ViewLayer.Combined.R"), names.index("ViewLayer.Depth.Z")
picture, depth = file.read_image(0, 0, first, first + 4, "float"), file.read_image(0, 0, z, z + 1, "float")
radius_px = numpy.clip((depth - 6.4) / depth, -1, 1) * 0.5 * 50**2 / 0.25 / 6400 * 1920 / 36
edges = numpy.linspace(42, -42, 17)
blurred = numpy.zeros_like(picture)
for far, near in zip(edges[:-1], edges[1:]):
    layer = picture * ((radius_px <= far) & (radius_px > near))
    side = 2 * round(abs(far + near) / 2) + 1
    disk = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (side, side)).astype(numpy.float32)
    layer = cv2.filter2D(layer, -1, disk / disk.sum(), borderType=cv2.BORDER_REPLICATE)
    blurred = layer + blurred * (1 - layer[..., 3:])
spec = oiio.ImageSpec(picture.shape[1], picture.shape[0], 4, "half")
spec.attribute("compression", "zip")
target = oiio.ImageOutput.create(sys.argv[2])
target.open(sys.argv[2], spec), target.write_image(blurred), target.close()
