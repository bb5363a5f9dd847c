"""Where a near object's blur covers what is behind it."""
import numpy


def near_band(coc):
    """Pixels within R of a depth edge whose near side, of radius R, is in front of the focus: an edge is where neighbours'
    CoC differ by more than 1 px and the nearer one's is below -1 px."""
    height, width = coc.shape
    radius = numpy.zeros_like(coc)
    for axis in 0, 1:
        a, b = (coc[:-1], coc[1:]) if axis == 0 else (coc[:, :-1], coc[:, 1:])
        nearer = numpy.minimum(a, b)
        reach = numpy.where((numpy.abs(a - b) > 1) & (nearer < -1), -nearer, 0)
        for part in (radius[:-1], radius[1:]) if axis == 0 else (radius[:, :-1], radius[:, 1:]):
            numpy.maximum(part, reach, out=part)
    band = numpy.zeros(coc.shape, dtype=bool)
    ys, xs = numpy.mgrid[0:height, 0:width]
    for y, x in numpy.argwhere(radius > 0):
        r = radius[y, x]
        low_y, high_y, low_x, high_x = (int(max(v, 0)) for v in (y - r, y + r + 1, x - r, x + r + 1))
        window = (slice(low_y, high_y), slice(low_x, high_x))
        band[window] |= (ys[window] - y) ** 2 + (xs[window] - x) ** 2 <= r * r
    return band
