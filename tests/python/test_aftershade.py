"""The Python package against the approved images, the program's own results and NumPy. Run by scripts/check python."""

import json
import math
import multiprocessing
import os
import re
import threading
from pathlib import Path

import aftershade
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
CASES = sorted(ROOT.glob("effects/**/cases/*.json"))
BLUR = {
    "aftershade": 1,
    "steps": [{"effect": "bokeh", "params": {"f_number": 0.5, "focus_distance": "6.4 m"}}, {"effect": "vignette"}],
}


@pytest.fixture(scope="session")
def host():
    with aftershade.Host(backend="osmesa") as host:
        yield host


def frame_arrays(width=48, height=32):
    """Color and depth by a formula: the left half near, the right half far."""
    y, x = np.mgrid[0:height, 0:width].astype(np.float32)
    color = np.stack([0.1 + 0.01 * x, 0.2 + 0.01 * y, np.full_like(x, 0.3), np.ones_like(x)], axis=-1)
    return {"color": color, "depth": np.where(x < width / 2, 2, 9).astype(np.float32)}


def is_case(path):
    return "steps" in (text := path.read_text()) or '"look"' in text


def relaxed_json(path):
    return json.loads(re.sub(r"^\s*//.*$", "", path.read_text(), flags=re.M))


@pytest.mark.parametrize("path", [p for p in CASES if is_case(p)], ids=lambda p: f"{p.parent.parent.name}/{p.stem}")
def test_every_shipped_case_equals_its_golden_to_the_bit(path, host, tmp_path):
    case = relaxed_json(path)
    capture = next((base / case["capture"] for base in (path.parent, ROOT) if (base / case["capture"]).exists()), None)
    if capture is None:
        pytest.skip(f"no capture {case['capture']}")
    source = path.parent / case["look"] if "look" in case else {"aftershade": 1, "steps": case["steps"]}
    options = {} if "look" in case else {"folder": path.parent}
    look = aftershade.Look(source, host=host, taps=case.get("taps", []), **options)
    for assignment in case.get("set", []):
        name, value = assignment.split("=", 1)
        look[name] = value
    sequence = aftershade.Sequence(capture, host=host)
    compared = 0
    for result in look.frames(sequence, frames_of(case.get("frames", ""), sequence.frames)):
        for role in case.get("outputs", ["color"]):
            golden = path.parent / f"{path.stem}.{role}.{result.frame:04}.exr"
            if not golden.exists():
                continue
            written = tmp_path / golden.name
            result.write(written, roles=[role])
            figures = aftershade.compare(golden, written)
            assert not figures.faults and all(layer.bits_equal for layer in figures.layers), figures
            compared += 1
    assert compared, "no golden was compared"


def frames_of(text, every):
    """Frames of a range such as 1-10x3,20."""
    frames = []
    for part in filter(None, str(text).split(",")):
        first, last, step = re.fullmatch(r"(-?\d+)(?:-(-?\d+))?(?:x(\d+))?", part).groups()
        frames += range(int(first), int(last or first) + 1, int(step or 1))
    return frames or every


def test_images_share_the_memory_of_results_and_outlive_them(host):
    result = aftershade.Look(BLUR, host=host).render(frame_arrays())
    color = result["color"]
    assert color.shape == (32, 48, 4) and color.dtype == np.float32
    assert not color.flags.writeable and not color.flags.owndata
    assert np.shares_memory(color, result["color"])
    kept = color.copy()
    del result
    assert np.array_equal(color, kept)


def test_a_key_may_have_an_interpolation_of_its_own(host):
    look = aftershade.Look(BLUR, host=host)
    arrays = frame_arrays()
    look["bokeh.f_number"] = {"keys": {"-100": {"value": 4, "interpolation": "step"}, "100": 0.5}}
    held = look.render(arrays)["color"]
    look["bokeh.f_number"] = 4
    assert np.array_equal(look.render(arrays)["color"], held)


def test_arrays_of_any_layout_give_the_same_pixels(host):
    arrays = frame_arrays()
    look = aftershade.Look(BLUR, host=host)
    expected = look.render(arrays)["color"]
    padded = np.zeros((32, 60, 4), np.float32)
    padded[:, :48] = arrays["color"]
    upside_down = arrays["color"][::-1].copy()
    planar = np.ascontiguousarray(arrays["color"].transpose(2, 0, 1))
    for color in (padded[:, :48], upside_down[::-1], planar.transpose(1, 2, 0), arrays["color"].astype(np.float64)):
        assert np.array_equal(look.render({**arrays, "color": color})["color"], expected)


def test_a_capture_gives_its_arrays_back(host):
    arrays = frame_arrays()
    ids = np.arange(48 * 32, dtype=np.int64).reshape(32, 48)
    capture = aftershade.Capture({**arrays, "object_id": ids}, camera={"f_number": 2.8, "camera_from_world": np.eye(4)})
    assert capture.roles == ["color", "depth", "object_id"]
    assert np.array_equal(capture["color"], arrays["color"]) and np.array_equal(capture["depth"], arrays["depth"])
    assert capture["object_id"].dtype == np.uint32 and np.array_equal(capture["object_id"], ids)
    assert capture.camera["f_number"] == 2.8 and capture.camera["camera_from_world"] == list(np.eye(4).ravel())
    copy = capture.copy()
    copy["depth"] = np.zeros((32, 48))
    assert capture["depth"].min() == 2


def test_parameters_have_what_describe_prints(host):
    look = aftershade.Look(BLUR, host=host)
    param = look.params["bokeh.f_number"]
    assert param.value == 0.5 and param.step == "bokeh" and param.origin == "the look" and param.doc
    look["bokeh.f_number"] = 4
    assert look["bokeh.f_number"] == 4 and look.params["bokeh.f_number"].origin == "set"
    look.reset("bokeh.f_number")
    assert look["bokeh.f_number"] == 0.5
    effect = host.effect("bokeh")
    assert {one.name for one in effect.params} == {name.split(".")[1] for name in look.params if name.startswith("bokeh.")}
    assert effect.sources and [port.role for port in effect.inputs][:1] == ["color"]
    assert "bokeh" in [one.id for one in host.effects()] and "blender" in host.profiles()


def test_the_package_has_the_looks_to_start_from(host):
    looks = sorted((Path(aftershade._host.shipped_data()) / "looks").glob("*.json"))
    assert {file.name for file in looks} == {file.name for file in (ROOT / "looks").glob("*.json")}
    for file in looks:
        assert aftershade.Look(file, host=host).params, file


def test_a_smaller_aperture_blurs_less(host):
    look, arrays = aftershade.Look(BLUR, host=host), frame_arrays()
    arrays["color"][4::8, 4::8, :3] = 20
    change = []
    for f_number in (0.3, 64):
        look["bokeh.f_number"] = f_number
        change.append(np.abs(look.render(arrays)["color"] - arrays["color"]).max())
    assert change[0] > 2 * change[1]


def test_sequences_carry_history(host):
    look = aftershade.Look({"aftershade": 1, "steps": [{"effect": "taa"}]}, host=host)
    arrays = {**frame_arrays(), "velocity": np.zeros((32, 48, 2), np.float32)}
    session = look.session()
    bright = {**arrays, "color": arrays["color"] * np.float32([2, 2, 2, 1])}
    resets = []
    for number, images in enumerate((arrays, bright, arrays), 1):
        resets.append(session.render(aftershade.Capture(images, frame=number)).history_reset)
    assert look.has_history and resets[0] and not resets[1] and not resets[2]
    jumped = session.render(aftershade.Capture(arrays, frame=9)).history_reset
    assert jumped


def write_frame(host, path, number, roles=("color", "depth"), **settings):
    arrays = {role: image for role, image in frame_arrays().items() if role in roles}
    capture = aftershade.Capture(arrays, frame=number)
    for name, value in settings.items():
        setattr(capture, name, value)
    aftershade.Look({"aftershade": 1, "steps": []}, host=host).render(capture).write(path, roles=roles, half=False)


def both_ways(host, tmp_path, frame):
    """A frame as the sequence reads it, and as a session renders it."""
    sequence = aftershade.Sequence(tmp_path / "f_####.exr", host=host)
    look = aftershade.Look({"aftershade": 1, "steps": []}, host=host)
    capture, (result,) = sequence.read(frame), look.frames(sequence, [frame], roles=["color"])
    assert np.array_equal(capture["color"], result["color"]) and capture.notes == result.notes
    return capture


def test_a_sequence_has_the_color_space_of_its_first_frame(host, tmp_path):
    write_frame(host, tmp_path / "f_0001.exr", 1)
    write_frame(host, tmp_path / "f_0002.exr", 2, color_space="acescg")
    capture = both_ways(host, tmp_path, 2)
    # AP1 of D60 to Rec. 709 of D65 by Bradford's method, as published with ACES.
    to_rec709 = [[1.70505, -0.62179, -0.08326], [-0.13026, 1.14080, -0.01055], [-0.02400, -0.12897, 1.15297]]
    expected = frame_arrays()["color"][..., :3] @ np.transpose(to_rec709)
    assert np.allclose(capture["color"][..., :3], expected, atol=1e-3) and capture.color_space == "rec709"
    assert any("converted to these" in note for note in capture.notes), capture.notes


def test_pixels_of_arrays_are_square_unless_their_shape_is_set(host):
    look = aftershade.Look({"aftershade": 1, "steps": [{"effect": "bloom"}]}, host=host)
    capture = aftershade.Capture(frame_arrays())
    assert capture.pixel_aspect == 1
    square = np.array(look.render(capture)["color"])
    capture.pixel_aspect = 2
    assert not np.array_equal(square, look.render(capture)["color"])
    with pytest.raises(aftershade.UsageError):
        capture.pixel_aspect = 0


def test_a_sequence_says_which_role_a_frame_lacks(host, tmp_path):
    write_frame(host, tmp_path / "f_0001.exr", 1)
    write_frame(host, tmp_path / "f_0002.exr", 2, roles=("color",))
    sequence = aftershade.Sequence(tmp_path / "f_####.exr", host=host, roles=["color", "depth"])
    assert sequence.read(1).notes == []
    assert sequence.read(2).notes == [f"it has no depth, which {tmp_path / 'f_0001.exr'} has"]


def test_a_sequence_says_that_its_pictures_have_two_sizes(host, tmp_path):
    write_frame(host, tmp_path / "f_0001.exr", 1)
    capture = aftershade.Capture(frame_arrays(24, 16), frame=2)
    aftershade.Look({"aftershade": 1, "steps": []}, host=host).render(capture).write(tmp_path / "f_0002.exr")
    (note,) = both_ways(host, tmp_path, 2).notes
    assert "its display window has 24 x 16 px, that of" in note and "f_0001.exr has 48 x 32" in note


def test_threads_may_share_a_host(host):
    look, arrays = aftershade.Look(BLUR, host=host), frame_arrays()
    expected, found = look.render(arrays)["color"], [None] * 4

    def work(i):
        found[i] = look.render(arrays)["color"]

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert all(np.array_equal(image, expected) for image in found)


def test_compare_has_the_figures_of_numpy(host):
    a = frame_arrays()["color"]
    b = a.copy()
    b[3, 5, 0] += 0.25
    same, other = aftershade.compare(a, a), aftershade.compare(a, b, maps=True)
    assert same and math.isinf(same.layers[0].psnr_db)
    layer = other.layers[0]
    assert not other and layer.failing == 1 and layer.largest_px == (5, 3) and layer.largest == pytest.approx(0.25, rel=1e-5)
    assert layer.rmse == pytest.approx(np.sqrt(np.mean(np.square(b[..., :3].astype(float) - a[..., :3]))), rel=1e-4)
    assert layer.flip_map.shape == (32, 48) and 0 < layer.flip_map.max() <= 1
    assert np.unravel_index(layer.flip_map.argmax(), (32, 48)) == (3, 5)
    assert layer.ssim_map.shape == (32, 48) and np.isnan(layer.ssim_map[:5]).all() and same.layers[0].ssim_map is None
    assert np.nanmean(layer.ssim_map) == pytest.approx(layer.ssim, abs=1e-6)
    assert np.allclose(layer.ssim_map[14:-5, 16:-5], 1, atol=1e-6), "windows without the changed pixel"


def test_compare_names_what_no_limit_holds(host):
    a, b = frame_arrays()["color"], frame_arrays()["color"]
    b[..., 3] = 0
    found = aftershade.compare(a, b, limit=math.inf, fail_flip=0.01)
    assert found and found.not_judged == ["A"] and not found["A"].is_judged and found["color"].is_judged
    assert not aftershade.compare(a, b).not_judged and found.warnings == found.notes == []


def test_check_velocity_tells_a_wrong_sign(host):
    paths = [ROOT / f"scenes/suzanne/gbuffer_000{number}.exr" for number in (3, 4)]
    (of_files, *_), (of_captures, *_) = (
        aftershade.check_velocity(*paths, host=host),
        aftershade.check_velocity(*(aftershade.Capture(path, host=host) for path in paths)),
    )
    assert of_files.role == of_captures.role == "velocity" and of_files.score == of_captures.score
    arrays = []
    for path in paths:
        capture = aftershade.Capture(path, host=host)
        arrays.append({"color": capture["color"], "velocity": -capture["velocity"]})
    reversed_check = aftershade.check_velocity(*arrays)[0]
    assert not reversed_check and reversed_check.verdict == "wrong", reversed_check.sentence
    assert reversed_check.suggested.delta == "prev-cur" and "prev-cur" in reversed_check.sentence
    with pytest.raises(TypeError, match="two files or two captures"):
        aftershade.check_velocity(paths[0], arrays[1])


def test_notebooks_show_pictures(host):
    look = aftershade.Look(BLUR, host=host)
    assert look._repr_png_() is None
    result = look.render(frame_arrays())
    assert result._repr_png_().startswith(b"\x89PNG\r\n\x1a\n") and look._repr_png_() == result._repr_png_()


def test_writing_equals_the_array(host, tmp_path):
    result = aftershade.Look(BLUR, host=host).render(frame_arrays())
    result.write(tmp_path / "out.exr", half=False)
    read = aftershade.Capture(tmp_path / "out.exr", host=host)
    assert np.array_equal(read["color"], result["color"])


def with_array(role, array):
    return lambda host: aftershade.Look(BLUR, host=host).render({**frame_arrays(), role: array})


MISUSES = {
    "no such file": (lambda host: aftershade.Look("nowhere.json", host=host), aftershade.Error, "nowhere.json"),
    "no JSON": (lambda host: aftershade.Look(write_look("{"), host=host), aftershade.DocumentError, "look.json:1"),
    "unknown effect": (
        lambda host: aftershade.Look({"aftershade": 1, "steps": [{"effect": "bokhe"}]}, host=host),
        aftershade.DocumentError,
        "did you mean",
    ),
    "unknown parameter": (lambda host: set_param(host, "bokeh.f_numbr", 1), aftershade.UsageError, "f_numbr"),
    "out of range": (lambda host: set_param(host, "bokeh.f_number", -1), aftershade.UsageError, "f_number"),
    "wrong type": (lambda host: set_param(host, "bokeh.f_number", [1, 2]), aftershade.UsageError, "f_number"),
    "handle beyond the key": (
        lambda host: set_param(host, "bokeh.f_number", {"keys": {"1": {"value": 4, "interpolation": [0, 0, 2, 1]}}}),
        aftershade.UsageError,
        "handles of a curve",
    ),
    "no form in JSON": (lambda host: set_param(host, "bokeh.f_number", object()), TypeError, "object"),
    "missing role": (
        lambda host: aftershade.Look(BLUR, host=host).render({"color": frame_arrays()["color"]}),
        aftershade.CaptureError,
        "depth",
    ),
    "wrong size": (with_array("depth", np.ones((31, 48), np.float32)), aftershade.UsageError, "31"),
    "wrong channels": (with_array("depth", np.ones((32, 48, 2), np.float32)), aftershade.UsageError, "channel"),
    "one dimension": (with_array("depth", np.ones(48, np.float32)), ValueError, "shape"),
    "text": (with_array("depth", np.full((32, 48), "x")), TypeError, "numbers"),
    "negative ids": (with_array("object_id", np.full((32, 48), -1)), ValueError, "uint32"),
    "unknown role": (with_array("colour", np.ones((32, 48), np.float32)), aftershade.UsageError, "colour"),
    "no images": (lambda host: aftershade.Look(BLUR, host=host).render({}), ValueError, "needs an image"),
    "unknown camera field": (lambda host: aftershade.Capture(frame_arrays(), camera={"fnumber": 1}), TypeError, "fnumber"),
    "camera out of range": (lambda host: aftershade.Capture(frame_arrays(), camera={"f_number": -1}), aftershade.UsageError, "f_number"),
    "unknown profile": (
        lambda host: aftershade.Capture(ROOT / "scenes/starter/starter_0001.exr", host=host, profile="blendr"),
        aftershade.Error,
        "blendr",
    ),
    "no such tap": (lambda host: aftershade.Look(BLUR, host=host, taps=["bokeh.nothing"]), aftershade.Error, "nothing"),
    "tap that was not wanted": (lambda host: aftershade.Look(BLUR, host=host).render(frame_arrays()).tap("bokeh.coc"), aftershade.UsageError, "coc"),
    "role that was not made": (lambda host: aftershade.Look(BLUR, host=host).render(frame_arrays())["normal"], aftershade.UsageError, "normal"),
    "unknown backend": (lambda host: aftershade.Host(backend="vulkan"), ValueError, "vulkan"),
    "unknown device": (lambda host: aftershade.Host(backend="egl-software", device="card77").gl(), aftershade.UsageError, "'card77' is not there"),
    "no data": (lambda host: aftershade.Host(data="/nowhere"), aftershade.UsageError, "/nowhere"),
    "unwritable": (
        lambda host: aftershade.Look(BLUR, host=host).render(frame_arrays()).write("/proc/out.exr"),
        aftershade.OutputError,
        "/proc",
    ),
    "unknown extension": (lambda host: aftershade.Look(BLUR, host=host).render(frame_arrays()).write("out.jpg"), aftershade.UsageError, "jpg"),
    "a file and an array": (lambda host: aftershade.compare("a.exr", np.ones((2, 2))), TypeError, "two"),
    "arrays of two sizes": (lambda host: aftershade.compare(np.ones((2, 2), np.float32), np.ones((2, 3), np.float32), role="data"), aftershade.UsageError, "2"),
    "sequence without frames": (lambda host: aftershade.Sequence("nowhere_####.exr", host=host), aftershade.Error, "nowhere"),
    "effect like no other": (
        lambda host: aftershade.Look({"aftershade": 1, "steps": [{"effect": "x" * 14}]}, host=host),
        aftershade.DocumentError,
        "effect_paths names a folder",
    ),
    "unknown option": (lambda host: aftershade.Look(BLUR, host=host).render(frame_arrays(), colour=1), TypeError, "colour"),
    "unknown treatment of NaN": (lambda host: aftershade.Look(BLUR, host=host).render(frame_arrays(), non_finite="drop"), ValueError, "drop"),
}


def write_look(text):
    path = Path(os.environ["PYTEST_TMP"]) / "look.json"
    path.write_text(text)
    return path


def set_param(host, name, value):
    aftershade.Look(BLUR, host=host)[name] = value


@pytest.mark.parametrize("name", MISUSES)
def test_misuse_is_an_exception_that_names_the_fault(name, host, tmp_path, monkeypatch):
    monkeypatch.setenv("PYTEST_TMP", str(tmp_path))
    call, kind, words = MISUSES[name]
    with pytest.raises(kind, match=re.escape(words)) as raised:
        call(host)
    assert "--" not in str(raised.value), "an option of the command line"


def test_a_closed_host_says_so():
    closed = aftershade.Host(backend="osmesa")
    look = aftershade.Look(BLUR, host=closed)
    closed.close()
    with pytest.raises(aftershade.UsageError, match="closed"):
        look.render(frame_arrays())


def test_faults_have_their_place(host, tmp_path):
    look = tmp_path / "look.json"
    look.write_text('{ "aftershade": 1,\n  "steps": [ { "effect": "bokeh", "params": { "f_numer": 2 } } ] }\n')
    with pytest.raises(aftershade.DocumentError) as raised:
        aftershade.Look(look, host=host)
    assert raised.value.file == str(look) and raised.value.line == 2 and raised.value.column > 0
    assert raised.value.kind == "document" and "f_number" in raised.value.message


def test_memory_stays_flat(host):
    look, capture = aftershade.Look(BLUR, host=host), aftershade.Capture(frame_arrays(160, 90))
    session = look.session()

    def resident_kib():
        return int(re.search(r"VmRSS:\s+(\d+)", Path("/proc/self/status").read_text())[1])

    at_20 = 0
    for number in range(1, 501):
        capture.frame = number
        session.render(capture)["color"]
        if number == 20:
            at_20 = resident_kib()
    assert resident_kib() <= at_20 * 1.02


def mean_of_a_frame(_):
    own = aftershade.Host(backend="software")
    return float(aftershade.Look(BLUR, host=own).render(frame_arrays())["color"].mean())


def test_a_spawned_pool_renders_and_a_forked_one_raises_at_once(host):
    expected = float(aftershade.Look(BLUR, host=host).render(frame_arrays())["color"].mean())
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        assert pool.map_async(mean_of_a_frame, range(2)).get(timeout=120) == [expected, expected]
    with multiprocessing.get_context("fork").Pool(2) as pool:
        with pytest.raises(aftershade.UsageError, match="spawn"):
            pool.map_async(mean_of_a_frame, range(2)).get(timeout=120)
    assert float(aftershade.Look(BLUR, host=host).render(frame_arrays())["color"].mean()) == expected


def test_the_example_of_the_readme_runs(tmp_path, monkeypatch):
    example = re.search(r"^```python\n(.*?)^```$", (ROOT / "README.md").read_text(), flags=re.M | re.S)[1]
    (tmp_path / "portrait.json").write_text((ROOT / "scenes/looks/portrait.json").read_text())
    (tmp_path / "frame.exr").symlink_to(ROOT / "scenes/suzanne/gbuffer_0003.exr")
    monkeypatch.chdir(tmp_path)
    *lines, last = example.rstrip().splitlines()
    names = {}
    exec("\n".join([*lines, "result = " + last]), names)
    assert names["look"]["bokeh.f_number"] == 2
    assert names["result"].dtype == np.float32 and names["result"].shape == (270, 480, 4)
    assert np.isfinite(names["result"]).all()
