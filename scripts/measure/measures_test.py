"""The measures of this package against closed forms."""
import math
import unittest

import numpy

from measure import measures

RGB_ONE = numpy.ones((4, 5, 3))


class Measures(unittest.TestCase):
    def test_srgb_has_the_values_of_its_standard(self) -> None:
        # IEC 61966-2-1: linear 0.2140 is 0.5, and below 0.0031308 it is a line.
        linear = numpy.array([-1.0, 0.0, 0.001, 0.21404114, 1.0, 7.0])
        numpy.testing.assert_allclose(measures.srgb(linear), [0, 0, 0.01292, 0.5, 1, 1], atol=1e-6)
        self.assertEqual(measures.bytes_of(numpy.array([0.2140, 0.2160])).tolist(), [127, 128])

    def test_psnr_of_a_constant_difference_is_its_square_in_decibels(self) -> None:
        one_tenth = measures.srgb(0.5 * RGB_ONE) - measures.srgb(0.25 * RGB_ONE)
        self.assertAlmostEqual(measures.psnr_db(0.5 * RGB_ONE, 0.25 * RGB_ONE), -20 * math.log10(one_tenth[0, 0, 0]))
        self.assertEqual(measures.psnr_db(RGB_ONE, 3 * RGB_ONE), math.inf)  # both clamped to 1
        where = numpy.zeros((4, 5), dtype=bool)
        self.assertTrue(math.isnan(measures.psnr_db(RGB_ONE, 0 * RGB_ONE, where)))
        where[1, 2] = True
        self.assertAlmostEqual(measures.psnr_db(RGB_ONE, 0 * RGB_ONE, where), 0)

    def test_luminance_psnr_weighs_channels_by_rec_709(self) -> None:
        where = numpy.ones((4, 5), dtype=bool)
        for channel, weight in enumerate((0.2126, 0.7152, 0.0722)):
            other = numpy.zeros((4, 5, 3))
            other[..., channel] = 0.2
            self.assertAlmostEqual(measures.luminance_psnr_db(0 * RGB_ONE, other, where, 0.5), -20 * math.log10(0.1 * weight))
        self.assertAlmostEqual(measures.scale_of(numpy.arange(101.0).reshape(101, 1), numpy.ones(101, dtype=bool)), 0.5 / 90)

    def test_changed_pixels_are_those_whose_window_has_the_change(self) -> None:
        sharp, truth = numpy.zeros((60, 60, 3)), numpy.zeros((60, 60, 3))
        truth[27:29, 40:43] = 1  # 6 / 324 of the window, below 0.02
        self.assertFalse(measures.changed_pixels(sharp, truth).any())
        truth[29, 40:43] = 1
        # All of the 3 x 3 block, 9 / 324, lies in the window of x-8..x+9 and y-8..y+9.
        expected = numpy.zeros((60, 60), dtype=bool)
        expected[29 - 9:27 + 8 + 1, 42 - 9:40 + 8 + 1] = True
        numpy.testing.assert_array_equal(measures.changed_pixels(sharp, truth), expected)

    def test_polygons_have_their_area_and_the_rotation_of_their_side(self) -> None:
        for blades in 3, 5, 6, 8:
            area = 0.5 * blades * 20**2 * math.sin(2 * math.pi / blades)
            far, near = (measures.polygon_coverage(blades, 20, side, 47) for side in (False, True))
            self.assertAlmostEqual(far.sum() / area, 1, places=3)
            numpy.testing.assert_allclose(near, far[::-1, ::-1], atol=1e-12)
        self.assertEqual(measures.iou(numpy.array([True, True, False]), numpy.array([False, True, True])), 1 / 3)

    def test_coc_is_that_of_similar_triangles(self) -> None:
        depth = numpy.array([1.0, 2.0, 4.0, math.inf])
        # 200 mm at f/2.5: an aperture of 80 mm; at twice the focus distance half of what it is at infinity.
        at_infinity = 0.5 * 80 * 200 / 2000 * 1920 / 36
        numpy.testing.assert_allclose(measures.coc_px(depth, 2, 200, 2.5, 36, 1920), [-at_infinity, 0, at_infinity / 2, at_infinity])

    def test_the_near_band_is_a_disk_around_a_near_point(self) -> None:
        coc = numpy.zeros((41, 41))
        coc[20, 20] = -6
        ys, xs = numpy.mgrid[0:41, 0:41]
        # Around the point and its four neighbours, which share its edges.
        expected = sum((((ys - y) ** 2 + (xs - x) ** 2) <= 36 for y, x in ((20, 20), (19, 20), (21, 20), (20, 19), (20, 21))),
                       numpy.zeros((41, 41), dtype=bool))
        numpy.testing.assert_array_equal(measures.near_band(coc), expected)
        self.assertFalse(measures.near_band(-coc).any())

    def test_the_edge_response_is_odd_and_has_the_slope_of_burleys_line(self) -> None:
        x = numpy.array([-30.0, -2, -1e-3, 0, 1e-3, 2, 30])
        response = measures.edge_response(x)
        numpy.testing.assert_allclose(response + response[::-1], 1, atol=1e-12)
        self.assertAlmostEqual(response[-1], 1, places=4)
        # The transform of the response's slope is the modulation.
        at = numpy.linspace(-60, 60, 24001)
        slope = numpy.gradient(measures.edge_response(at), at)
        for w in 0.5, 1.0, 2.0:
            self.assertAlmostEqual(float((slope * numpy.cos(w * at)).sum() * (at[1] - at[0])), measures.modulation(w), places=2)


if __name__ == "__main__":
    unittest.main()
