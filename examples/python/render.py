"""Renders a capture with depth of field at two apertures and compares the results: render.py CAPTURE OUT.exr"""

import sys

import aftershade


def main(capture_path: str, out: str) -> None:
    look = aftershade.Look({"aftershade": 1, "steps": [{"effect": "bokeh", "params": {"f_number": 1.4}}]})
    param = look.params["bokeh.f_number"]
    print(f"{param.name}: {param.value} (from {param.min} to {param.max}): {param.doc}")

    capture = aftershade.Capture(capture_path)
    wide = look.render(capture, timed=True)
    wide.write(out)
    print(f"{capture!r}: {sum(ms for _, ms in wide.times_ms):.0f} ms")

    look["bokeh.f_number"] = 8
    narrow = look.render(capture)
    print(f"FLIP between the two: {aftershade.compare(wide['color'], narrow['color']).layers[0].hdr_flip}")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
