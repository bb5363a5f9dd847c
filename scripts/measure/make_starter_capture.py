"""Writes scenes/starter/gbuffer_0001.exr and _0002.exr, the small capture of the effects' cases: spheres over a checkered floor
before nothing, three lamps, a moving ball."""
import numpy as np
import OpenEXR

from measure.exr import write_exr
from measure.measures import Array
from measure.tree import ROOT

WIDTH, HEIGHT = 240, 135
FOCAL_PX = WIDTH * 50 / 36  # 50 mm on a sensor 36 mm wide
SUPERSAMPLES = 4            # a side, for colour alone: depth, motion and ids are those of the pixel's centre
LIGHT = np.array([-0.5, 0.7, 0.5]) / np.linalg.norm([-0.5, 0.7, 0.5])

Sphere = tuple[tuple[float, ...], float, tuple[float, ...], tuple[float, ...], tuple[float, ...]]
# Centre in m (view space: looks along -z, y up), radius, albedo, emission, velocity in m a frame.
SPHERES: list[Sphere] = [
    ((-0.55, -0.1, -4.0), 0.40, (0.80, 0.25, 0.10), (0, 0, 0), (0.06, 0.015, 0)),
    ((0.25, -0.15, -5.5), 0.55, (0.12, 0.45, 0.70), (0, 0, 0), (0, 0, 0)),
    ((0.62, -0.28, -3.2), 0.22, (0.75, 0.72, 0.65), (0, 0, 0), (-0.02, 0, 0)),
    ((-1.60, 0.15, -9.0), 0.80, (0.25, 0.60, 0.20), (0, 0, 0), (0, 0, 0)),
    ((1.30, 0.80, -8.0), 0.10, (0, 0, 0), (60, 42, 20), (0, 0, 0)),
    ((-0.20, 0.95, -8.0), 0.05, (0, 0, 0), (120, 130, 160), (0, 0, 0)),
    ((1.05, 0.20, -6.0), 0.03, (0, 0, 0), (400, 60, 30), (0, 0, 0)),
]
FLOOR_Y, FLOOR_FAR_M = -0.65, 14.0
MIDDLE = np.zeros(3)  # of the lens


def centre(sphere: Sphere, frame: int) -> Array:
    return np.array(sphere[0]) + frame * np.array(sphere[4])


def trace(rays: Array, frame: int, eye: Array = MIDDLE) -> tuple[Array, Array, Array]:
    """Nearest hit: distance along the view axis, id (0 nothing, 1 the floor, 2.. spheres), colour. `eye`: a point of the lens."""
    depth = np.full(rays.shape[:2], np.inf)
    ids = np.zeros(rays.shape[:2], np.uint32)
    color = np.zeros(rays.shape)
    with np.errstate(divide="ignore"):
        t = (FLOOR_Y - eye[1]) / rays[..., 1]  # rays have z = -1, so t is the distance along the axis
    floor = (t > 0) & (t < FLOOR_FAR_M)
    point = eye + rays * np.where(floor, t, 1)[..., None]
    checks = (np.floor(point[..., 0] * 2) - np.floor(point[..., 2] * 2)) % 2
    shade = 0.15 + LIGHT[1] * shadow(point, frame)
    depth[floor], ids[floor] = t[floor], 1
    color[floor] = (np.where(checks, 0.42, 0.12) * shade)[floor, None] * (1, 0.95, 0.85)
    for index, sphere in enumerate(SPHERES):
        c, (_, radius, albedo, emission, _) = centre(sphere, frame) - eye, sphere
        a, b = (rays**2).sum(-1), rays @ c
        root = b * b - a * (c @ c - radius**2)
        t = (b - np.sqrt(np.maximum(root, 0))) / a
        hit = (root > 0) & (t > 0) & (t < depth)
        point = rays * t[..., None]
        normal = (point - c) / radius
        diffuse = 0.12 + 0.05 * normal[..., 1] + np.maximum(normal @ LIGHT, 0)
        half = LIGHT - rays / np.sqrt(a)[..., None]
        half /= np.linalg.norm(half, axis=-1, keepdims=True)
        # Beside the sphere "normal" has any length.
        gloss = 6 * np.clip((normal * half).sum(-1), 0, 1) ** 200 * any(albedo)
        depth[hit], ids[hit] = t[hit], index + 2
        color[hit] = (np.array(albedo) * diffuse[..., None] + gloss[..., None] + np.array(emission))[hit]
    return depth, ids, color


def shadow(points: Array, frame: int) -> Array:
    lit = np.ones(points.shape[:2])
    for sphere in SPHERES:
        away = points - centre(sphere, frame)
        b = away @ LIGHT
        lit *= 1.0 - ((b * b - ((away**2).sum(-1) - sphere[1] ** 2) > 0) & (b < 0))
    return lit


def rays_at(dx: float, dy: float) -> Array:
    x, y = np.meshgrid(np.arange(WIDTH) + dx, np.arange(HEIGHT) + dy)
    return np.stack([(x - WIDTH / 2) / FOCAL_PX, (HEIGHT / 2 - y) / FOCAL_PX, -np.ones_like(x)], -1)


def velocity(depth: Array, ids: Array, frame: int) -> Array:
    """px a frame, current minus previous position; +y down."""
    result = np.zeros(ids.shape + (2,))
    point = rays_at(0.5, 0.5) * np.where(np.isfinite(depth), depth, 1)[..., None]
    for index, sphere in enumerate(SPHERES):
        before = point - np.array(sphere[4])
        moved = [(point[..., 0] / -point[..., 2] - before[..., 0] / -before[..., 2]) * FOCAL_PX,
                 -(point[..., 1] / -point[..., 2] - before[..., 1] / -before[..., 2]) * FOCAL_PX]
        here = ids == index + 2
        result[here] = np.stack(moved, -1)[here]
    return result


def sky(rays: Array) -> Array:
    """Behind everything, from dark blue to warm below: wholly covered, but at no distance."""
    height = (0.5 - rays[..., 1:2] * FOCAL_PX / HEIGHT - 0.5 / HEIGHT) * HEIGHT / (HEIGHT - 1)
    return (1 - height) * np.array([0.02, 0.05, 0.16]) + height * np.array([0.55, 0.30, 0.14])


def through_lens(frame: int, focus_m: float, radius_m: float, samples: int) -> Array:
    """The colour through a round thin lens, one ray a sample and pixel, by the R4 sequence (Roberts 2018)."""
    color = np.zeros((HEIGHT, WIDTH, 3))
    for i in range(samples):
        r, turn, dx, dy = (0.5 + i * np.array([0.8566748838545029, 0.733891856627126, 0.6287067210378087, 0.5385972572236101])) % 1
        eye = radius_m * np.sqrt(r) * np.array([np.cos(2 * np.pi * turn), np.sin(2 * np.pi * turn), 0])
        rays = rays_at(dx, dy) - eye / focus_m
        depth, _, part = trace(rays, frame, eye)
        color += np.where(np.isfinite(depth)[..., None], part, sky(rays)) / samples
    return color


def render(frame: int) -> dict[str, Array]:
    color, alpha = np.zeros((HEIGHT, WIDTH, 3)), np.zeros((HEIGHT, WIDTH))
    steps = (np.arange(SUPERSAMPLES) + 0.5) / SUPERSAMPLES
    for dy in steps:
        for dx in steps:
            depth, _, part = trace(rays_at(dx, dy), frame)
            color += part / SUPERSAMPLES**2
            alpha += np.isfinite(depth) / SUPERSAMPLES**2
    color += sky(rays_at(0.5, 0.5)) * (1 - alpha)[..., None]
    depth, ids, _ = trace(rays_at(0.5, 0.5), frame)
    motion = velocity(depth, ids, frame)
    half, single = np.float16, np.float32
    channels: dict[str, Array] = {"A": np.ones_like(alpha).astype(half), "Z": depth.astype(single), "object_id.I": ids}
    channels |= {name: color[..., i].astype(half) for i, name in enumerate("RGB")}
    channels |= {f"velocity.{name}": motion[..., i].astype(single) for i, name in enumerate("XY")}
    return channels


def main() -> None:
    for number in (1, 2):
        write_exr(ROOT / f"scenes/starter/gbuffer_{number:04}.exr", render(number), OpenEXR.ZIP_COMPRESSION)


if __name__ == "__main__":
    main()
