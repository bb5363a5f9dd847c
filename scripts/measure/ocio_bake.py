"""Bakes views of a newer OpenColorIO's config into a config that OpenColorIO 2.1 reads, with a LUT for each view transform."""
import argparse
import pathlib
import sys
from collections.abc import Callable, Sequence

import numpy
import PyOpenColorIO as ocio

from measure.measures import Array

Function = Callable[[Array], Array]
POINTS = 65
LOG_POINTS = 8192
# What a shaper holds: stops above 1 at its end, and the light that its logarithm adds, of which the best one is taken.
TOP_STOPS, TOES = 8.0, (3e-3, 4e-3, 6e-3)
# Share of the logarithm beside the view's own curve of greys, which alone would leave bright colours too few points.
LOG_SHARE = 0.45
# And beside a density of points by how the view bends, along lines of one channel's light through the others'.
BEND_SHARES, BEND_POINTS, BEND_LINES = (0.3, 0.4, 0.5), 257, 300
# Colours that a cube is fitted to, the number of best shapers that it is tried with, and the steps towards the least squares.
FIT_COLORS, FIT_SHAPERS, FIT_STEPS = 2_000_000, 5, 8
# Offset of the curve in which cubes hold light for a display of usual brightness; sRGB's own is 0.055.
STRAIGHT_PART = 0.035
# Displays as OpenColorIO 2.1 has them, so that the program finds the encoding for PNG.
DISPLAYS = ["sRGB", "REC.1886-REC.709", "G2.2-REC.709", "G2.6-P3-D65", "REC.2100-PQ", "ST2084-P3-D65",
            "REC.2100-HLG-1000nit"]
# Linear Rec. 709, by BabelColor's averages of the ColorChecker of 2012.
PATCHES = [(.17, .08, .06), (.54, .30, .22), (.12, .19, .34), (.10, .15, .05), (.23, .22, .44), (.13, .50, .40), (.67, .20, .03),
           (.08, .11, .39), (.53, .09, .13), (.11, .05, .15), (.34, .50, .05), (.76, .36, .03), (.03, .05, .29), (.06, .30, .07),
           (.42, .04, .04), (.84, .57, .01), (.49, .09, .30), (.01, .24, .38), (.88, .88, .86), (.58, .59, .58), (.36, .36, .36),
           (.19, .19, .19), (.09, .09, .09), (.03, .03, .03)]


def applied(processor: ocio.Processor, colors: Array) -> Array:
    values = numpy.ascontiguousarray(colors, dtype=numpy.float32).reshape(-1, 3).copy()
    processor.getDefaultCPUProcessor().applyRGB(values)
    return values


def random_colors() -> Array:
    """20000 of Rec. 709, most of them saturated, over 13 stops: none that a shaper was chosen by."""
    random = numpy.random.default_rng(7)
    return 2.0 ** random.uniform(-8, 5, (20000, 1)) * 3 * random.dirichlet((1, 1, 1), 20000)


def ends_of_log(toe: float) -> tuple[float, float]:
    return float(numpy.log2(toe)), float(numpy.log2(2.0 ** TOP_STOPS + toe))


def light_from_log(shares: Array, toe: float) -> Array:
    low, high = ends_of_log(toe)
    return 2.0 ** (low + shares * (high - low)) - toe


def test_colors() -> Array:
    """A chart from -6 to 6 stops, and ramps of greys over 24 stops; linear Rec. 709."""
    chart = [numpy.asarray(PATCHES) * 2.0 ** stops for stops in numpy.arange(-6, 6.5, 0.5)]
    return numpy.concatenate([*chart, numpy.repeat(2.0 ** numpy.linspace(-16, 8, 2000)[:, None], 3, 1)])


def log_transform(toe: float) -> ocio.LogAffineTransform:
    low, high = ends_of_log(toe)
    return ocio.LogAffineTransform(logSideSlope=[1 / (high - low)] * 3, logSideOffset=[-low / (high - low)] * 3,
                                   linSideSlope=[1.0] * 3, linSideOffset=[toe] * 3)


def floor_transform() -> ocio.RangeTransform:
    """A logarithm has no value for light below 0."""
    return ocio.RangeTransform(minInValue=0.0, minOutValue=0.0)


def is_simple(transform: ocio.Transform) -> bool:
    return isinstance(transform, (ocio.MatrixTransform, ocio.RangeTransform, ocio.ExponentTransform, ocio.ExponentWithLinearTransform))


def curve_of_displays(is_bright: bool, direction: ocio.TransformDirection) -> ocio.Transform:
    """To light from the numbers that a cube holds. A straight part near black keeps what is below 0 near."""
    if is_bright:
        return ocio.BuiltinTransform(style="CURVE - ST-2084_to_LINEAR", direction=direction)
    return ocio.ExponentWithLinearTransform(gamma=[2.4, 2.4, 2.4, 1], offset=[*[STRAIGHT_PART] * 3, 0], direction=direction)


class Shaper:
    """A curve of each channel over the shares of a logarithm, and the light at the points of a cube's sides."""

    def __init__(self, curve: Array, toe: float) -> None:
        self.curve, self.toe = curve, toe
        side = numpy.linspace(0, 1, POINTS)
        self.corners = self.light_at(numpy.stack(numpy.meshgrid(side, side, side, indexing="ij"), -1))

    def light_at(self, places: Array) -> Array:
        """The light that comes to these places in the cube, from 0 to 1 along each side."""
        shares = numpy.linspace(0, 1, LOG_POINTS)
        return numpy.stack([light_from_log(numpy.interp(places[..., c], self.curve[:, c], shares), self.toe) for c in range(3)], -1)

    def before_cube(self) -> list[ocio.Transform]:
        lut = ocio.Lut1DTransform(length=LOG_POINTS, inputHalfDomain=False)
        lut.setData(self.curve.astype(numpy.float32).ravel())
        return [floor_transform(), log_transform(self.toe), lut]


def shaper_of_greys(view: Function, toe: float) -> Shaper:
    shares = numpy.linspace(0, 1, LOG_POINTS)
    grey = numpy.maximum.accumulate(view(numpy.repeat(light_from_log(shares, toe)[:, None], 3, 1))[:, 1])
    curve = (1 - LOG_SHARE) * (grey - grey[0]) / (grey[-1] - grey[0]) + LOG_SHARE * shares
    return Shaper(numpy.repeat(curve[:, None], 3, 1), toe)


def shaper_of_bends(view: Function, toe: float, share: float) -> Shaper:
    """The error between points goes with the second derivative and the square of their distance."""
    places = numpy.random.default_rng(1).random((BEND_LINES, 3))
    places[:BEND_LINES // 4] = places[:BEND_LINES // 4, :1]
    shares, curves = numpy.linspace(0, 1, BEND_POINTS), []
    for channel in range(3):
        lines = numpy.repeat(places[:, None, :], BEND_POINTS, 1)
        lines[:, :, channel] = shares
        values = numpy.clip(view(light_from_log(lines, toe)).reshape(BEND_LINES, BEND_POINTS, 3), -0.05, 1.05)
        bends = numpy.nan_to_num(numpy.abs(numpy.diff(values, 2, axis=1)).max(axis=2))
        bend = numpy.pad(numpy.sqrt((bends ** 2).mean(axis=0)), 5, "edge")
        density = numpy.sqrt(numpy.convolve(bend, numpy.ones(9) / 9, "valid"))
        density = (1 - share) * density / density.mean() + share
        curve = numpy.concatenate([[0], numpy.cumsum((density[1:] + density[:-1]) / 2)])
        curves.append(numpy.interp(numpy.linspace(0, 1, LOG_POINTS), shares, curve / curve[-1]))
    return Shaper(numpy.stack(curves, -1), toe)


def fitted(cube: Array, shaper: Shaper, view: Function) -> Array:
    """The cube whose tetrahedra are near the view in the mean of squares. Where a view bends, values at the corners alone leave all
    that lies between them off to one side. A quarter of the colours is near grey."""
    random = numpy.random.default_rng(3)
    places = random.random((FIT_COLORS, 3))
    greys = FIT_COLORS // 4
    places[:greys] = numpy.clip(places[:greys, :1] + random.normal(0, 2 / POINTS, (greys, 3)), 0, 1)
    exact = view(shaper.light_at(places))
    cells = numpy.minimum((places * (POINTS - 1)).astype(int), POINTS - 2)
    inside = places * (POINTS - 1) - cells
    # A tetrahedron's corners: from the cell's first one along the channel that is furthest inside, then the next.
    order = numpy.argsort(-inside, axis=1)
    far = numpy.take_along_axis(inside, order, 1)
    weights = numpy.stack([1 - far[:, 0], far[:, 0] - far[:, 1], far[:, 1] - far[:, 2], far[:, 2]], -1)
    strides = numpy.array([POINTS * POINTS, POINTS, 1])
    corners = (cells @ strides)[:, None] + numpy.pad(numpy.cumsum(strides[order], axis=1), ((0, 0), (1, 0)))
    of_corners = numpy.maximum(numpy.bincount(corners.ravel(), weights.ravel(), POINTS ** 3), 1e-3)
    values = cube.reshape(-1, 3).astype(float)
    for _ in range(FIT_STEPS):
        apart = exact - (weights[..., None] * values[corners]).sum(1)
        for c in range(3):
            values[:, c] += numpy.bincount(corners.ravel(), (weights * apart[:, c:c + 1]).ravel(), POINTS ** 3) / of_corners
    return values


class Baker:
    def __init__(self, path: str, folder: pathlib.Path) -> None:
        self.source = ocio.Config.CreateFromFile(path)
        self.folder = folder
        self.baked = ocio.Config()
        self.baked.setVersion(2, 1)
        self.baked.setSearchPath("luts")
        self.baked.addColorSpace(ocio.ColorSpace(name="ACES2065-1"))
        self.baked.addColorSpace(ocio.ColorSpace(ocio.REFERENCE_SPACE_DISPLAY, "CIE XYZ-D65"))
        for role, space in (("default", "ACES2065-1"), ("aces_interchange", "ACES2065-1"), ("cie_xyz_d65_interchange", "CIE XYZ-D65")):
            self.baked.setRole(role, space)
        self.ap0_from_709 = self.source.getProcessor("Linear Rec.709 (sRGB)", "ACES2065-1")
        self.luts = 0

    def view(self, display: str, view: str) -> ocio.Processor:
        return self.source.getProcessor(ocio.DisplayViewTransform(src="ACES2065-1", display=display, view=view))

    def space_of(self, display: str, view: str) -> str:
        return self.source.getDisplayViewColorSpaceName(display, view).replace("<USE_DISPLAY_NAME>", display)

    def encoding_of(self, space: str) -> ocio.Transform | None:
        """What OpenColorIO 2.1 has for the display's numbers of CIE XYZ: a transform by name, or matrices and exponents."""
        greys = numpy.linspace(0.02, 1, 50)[:, None] * numpy.array([[1, 1, 1], [1, .6, .5], [.5, 1, .6], [.5, .6, 1]])[:, None]
        expected = applied(self.source.getProcessor(space, "cie_xyz_d65_interchange"), greys)
        for name in DISPLAYS:
            style = f"DISPLAY - CIE-XYZ-D65_to_{name}"
            back = self.source.getProcessor(ocio.BuiltinTransform(style=style), ocio.TRANSFORM_DIR_INVERSE)
            if numpy.allclose(applied(back, greys), expected, rtol=1e-3, atol=1e-4):
                return ocio.BuiltinTransform(style=style)
        steps = self.source.getProcessor("cie_xyz_d65_interchange", space).createGroupTransform()
        return steps if all(is_simple(step) for step in steps) else None

    def is_in_two(self, display: str, view: str) -> bool:
        """Whether a view is a view transform of ACES2065-1, then an encoding of CIE XYZ: without a look, and not over other
        references."""
        own = self.source.getViewTransform(self.source.getDisplayViewTransformName(display, view))
        if own is None or self.source.getDisplayViewLooks(display, view):
            return False
        spaces = [self.source.getColorSpace(name) for name in ("ACES2065-1", "cie_xyz_d65_interchange")]
        return own.getTransform(ocio.VIEWTRANSFORM_DIR_FROM_REFERENCE) is not None and all(
            space and space.getTransform(direction) is None for space in spaces
            for direction in (ocio.COLORSPACE_DIR_TO_REFERENCE, ocio.COLORSPACE_DIR_FROM_REFERENCE))

    def baked_steps(self, whole: ocio.Processor) -> ocio.GroupTransform:
        """From ACES2065-1: a shaper and a cube, whose files it writes, up to the last step that OpenColorIO 2.1 lacks; then the
        steps after it. So a clamp, which is a bend of its own, is exact behind the cube."""
        steps = list(whole.createGroupTransform())
        end = next((at for at in range(len(steps), 0, -1) if not is_simple(steps[at - 1])), 0)
        if end == 0:
            return ocio.GroupTransform(steps)
        matrix = numpy.eye(4)
        matrix[:3, :3] = applied(self.source.getProcessor("ACES2065-1", "Linear P3-D65"), numpy.eye(3)).T
        to_p3 = ocio.MatrixTransform(matrix=matrix.reshape(-1).tolist())
        head = self.source.getProcessor(ocio.GroupTransform(steps[:end]))
        # The cube holds numbers as an eye counts them: light that steps follow by a curve for displays of its range.
        is_bright = applied(head, numpy.array([[2.0 ** TOP_STOPS] * 3])).max() > 1.05
        curve = [] if end == len(steps) else [curve_of_displays(is_bright, ocio.TRANSFORM_DIR_INVERSE)]
        curved = self.source.getProcessor(ocio.GroupTransform([*steps[:end], *curve]))
        from_p3 = self.source.getProcessor(to_p3, ocio.TRANSFORM_DIR_INVERSE)
        shaper, cube = self.best_cube(to_p3, lambda light: applied(curved, applied(from_p3, light)))
        shaper_name, cube_name = self.write_luts(shaper, cube)
        back = [curve_of_displays(is_bright, ocio.TRANSFORM_DIR_FORWARD)] if curve else []
        return ocio.GroupTransform([to_p3, floor_transform(), log_transform(shaper.toe),
                                    ocio.FileTransform(src=shaper_name, interpolation=ocio.INTERP_LINEAR),
                                    ocio.FileTransform(src=cube_name, interpolation=ocio.INTERP_TETRAHEDRAL), *back, *steps[end:]])

    def best_cube(self, to_p3: ocio.MatrixTransform, of_p3: Function) -> tuple[Shaper, Array]:
        """Of several shapers the one with the least error over the chart."""
        colors = applied(self.ap0_from_709, test_colors())
        exact = numpy.clip(of_p3(applied(self.source.getProcessor(to_p3), colors)), 0, 1)

        def error_of(shaper: Shaper, cube: Array) -> float:
            lut = ocio.Lut3DTransform(gridSize=POINTS)
            lut.setData(cube.astype(numpy.float32).ravel())
            lut.setInterpolation(ocio.INTERP_TETRAHEDRAL)
            whole = self.source.getProcessor(ocio.GroupTransform([to_p3, *shaper.before_cube(), lut]))
            apart = numpy.abs(numpy.clip(applied(whole, colors), 0, 1) - exact)
            return float(numpy.nan_to_num(apart, nan=numpy.inf).max())

        shapers = [*(shaper_of_greys(of_p3, toe) for toe in TOES),
                   *(shaper_of_bends(of_p3, toe, share) for toe in TOES for share in BEND_SHARES)]
        tried = []
        for shaper in shapers:
            cube = of_p3(shaper.corners)
            tried.append((error_of(shaper, cube), shaper, cube))
        tried.sort(key=lambda found: found[0])
        for _, shaper, cube in tried[:FIT_SHAPERS]:
            better = fitted(cube, shaper, of_p3)
            tried.append((error_of(shaper, better), shaper, better))
        _, shaper, cube = min(tried, key=lambda found: found[0])
        return shaper, cube

    def write_luts(self, shaper: Shaper, cube: Array) -> tuple[str, str]:
        self.luts += 1
        shaper_name, cube_name = f"shaper_{self.luts}.spi1d", f"view_{self.luts}.spi3d"
        lines = "\n".join(" ".join(f"{value:.8g}" for value in row) for row in shaper.curve)
        (self.folder / "luts" / shaper_name).write_text(
            f"Version 1\nFrom 0 1\nLength {LOG_POINTS}\nComponents 3\n{{\n{lines}\n}}\n")
        # OpenColorIO's cubes run through blue first; its reader takes no denormal number.
        index = numpy.stack(numpy.meshgrid(*[numpy.arange(POINTS)] * 3, indexing="ij"), -1).reshape(-1, 3)
        values = numpy.where(numpy.abs(cube) < 1e-30, 0, cube)
        rows = "\n".join(f"{r} {g} {b} {x:.7g} {y:.7g} {z:.7g}" for (r, g, b), (x, y, z) in zip(index, values, strict=True))
        (self.folder / "luts" / cube_name).write_text(f"SPILUT 1.0\n3 3\n{POINTS} {POINTS} {POINTS}\n{rows}\n")
        return shaper_name, cube_name

    def add(self, display: str, view: str) -> None:
        transform, space = self.source.getDisplayViewTransformName(display, view), self.space_of(display, view)
        encoding = self.encoding_of(space) if self.is_in_two(display, view) else None
        if encoding is None:
            whole = self.baked_steps(self.view(display, view))
            self.baked.addColorSpace(ocio.ColorSpace(name=f"{display}, {view}", fromReference=whole))
            self.baked.addDisplayView(display, view, f"{display}, {view}")
            return
        if transform not in self.baked.getViewTransformNames():
            own = self.source.getViewTransform(transform)
            steps = [own.getTransform(ocio.VIEWTRANSFORM_DIR_FROM_REFERENCE)]
            if own.getReferenceSpaceType() == ocio.REFERENCE_SPACE_DISPLAY:
                steps.insert(0, ocio.ColorSpaceTransform("ACES2065-1", "cie_xyz_d65_interchange"))
            to_xyz = self.source.getProcessor(ocio.GroupTransform(steps))
            self.baked.addViewTransform(ocio.ViewTransform(
                referenceSpace=ocio.REFERENCE_SPACE_SCENE, name=transform, fromReference=self.baked_steps(to_xyz)))
        if space not in self.baked.getColorSpaceNames(ocio.SEARCH_REFERENCE_SPACE_DISPLAY, ocio.COLORSPACE_ALL):
            self.baked.addColorSpace(ocio.ColorSpace(ocio.REFERENCE_SPACE_DISPLAY, space, fromReference=encoding))
        self.baked.addDisplayView(display, view, transform, space, "", "", "")

    def write(self) -> pathlib.Path:
        path = self.folder / "config.ocio"
        path.write_text(self.baked.serialize())
        return path

    def errors(self, path: pathlib.Path, display: str, view: str, light: Array) -> Array:
        """Of each colour, in 1/1023."""
        colors = applied(self.ap0_from_709, light)
        baked = ocio.Config.CreateFromFile(str(path)).getProcessor(
            ocio.DisplayViewTransform(src="ACES2065-1", display=display, view=view))
        apart = numpy.clip(applied(baked, colors), 0, 1) - numpy.clip(applied(self.view(display, view), colors), 0, 1)
        return numpy.abs(apart).max(axis=1) * 1023


def main(words: Sequence[str]) -> None:
    parser = argparse.ArgumentParser(prog="scripts/make ocio-bake")
    parser.add_argument("config", help="a path, or an address such as ocio://default")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--display", help="one display (default: all)")
    parser.add_argument("--view", help="one view (default: all)")
    options = parser.parse_args(words)
    (options.folder / "luts").mkdir(parents=True, exist_ok=True)
    baker = Baker(options.config, options.folder)
    chosen = [(display, view) for display in baker.source.getDisplays() for view in baker.source.getViews(display)
              if options.display in (None, display) and options.view in (None, view)]
    chosen = [(display, view) for display, view in chosen if not baker.source.getColorSpace(
        baker.space_of(display, view)).isData()]
    if not chosen:
        sys.exit(f"{options.config} has no such display and view; its displays: {', '.join(baker.source.getDisplays())}")
    for display, view in chosen:
        baker.add(display, view)
    path = baker.write()
    for display, view in chosen:
        chart, others = (baker.errors(path, display, view, light) for light in (test_colors(), random_colors()))
        print(f"{display}, {view}: at most {chart.max():.2f}/1023, 99 % within {numpy.percentile(chart, 99):.2f}/1023; random colours: "
              f"at most {others.max():.2f}/1023, 99 % within {numpy.percentile(others, 99):.2f}/1023")
    print(path)


if __name__ == "__main__":
    main(sys.argv[1:])
