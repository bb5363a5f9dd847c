"""The one point light that a capture was lit by, from its picture: for captures that do not say."""
import numpy

from measure.measures import Array


def found_light(light: Array, position_m: Array, normal: Array, rounds: int = 60) -> tuple[Array, Array, float]:
    """Position (m) and intensity (RGB, W/sr) that explain irradiance over pi at the given points, all N x 3. Points in shadow are
    found on the way: what differs by more than a tenth from the light that it should have does not count in the end."""
    luminance = light.mean(axis=1)
    bright = luminance > numpy.percentile(luminance, 60)
    toward = normal[bright].mean(axis=0)
    guess = numpy.concatenate([position_m.mean(axis=0) + 5 * toward / numpy.linalg.norm(toward), [numpy.log(25 * luminance.max())]])

    def model(values: Array) -> Array:
        way = values[:3] - position_m
        length = numpy.linalg.norm(way, axis=1)
        return numpy.exp(values[3]) * numpy.maximum((way * normal).sum(axis=1), 0) / length**3

    def lit(now: Array, tolerance: float) -> Array:
        return (numpy.abs(luminance - now) < tolerance * now) & (now > 0.1 * luminance.max())

    damping = 1e-2
    for i in range(rounds):
        now = model(guess)
        counts = lit(now, 0.5 if i < rounds // 2 else 0.1)
        residual = (luminance - now)[counts]
        jacobian = numpy.stack([(model(guess + step) - now)[counts] / 1e-4 for step in 1e-4 * numpy.eye(4)], axis=1)
        normal_matrix = jacobian.T @ jacobian
        change = numpy.linalg.solve(normal_matrix + damping * numpy.diag(numpy.diag(normal_matrix)), jacobian.T @ residual)
        better = ((luminance - model(guess + change))[counts] ** 2).mean() < (residual**2).mean()
        guess, damping = (guess + change, damping / 3) if better else (guess, damping * 4)
    now = model(guess)
    counts = lit(now, 0.1)
    color = [numpy.median(light[counts, c] / luminance[counts]) for c in range(3)]
    # Irradiance is stored over pi.
    return guess[:3], numpy.pi * numpy.exp(guess[3]) * numpy.array(color), numpy.sqrt(((luminance - now)[counts] ** 2).mean())
