"""Checks what `aftershade` reads from the files that render_scene.py wrote.

    python check_files.py PROGRAM FOLDER
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile

PASSES = {"albedo", "color", "depth", "emission", "irradiance", "normal", "object_id", "position", "velocity",
          "velocity_next"}
OBJECTS = {"Suzanne", "Cube", "Floor"}


class Check:
    def __init__(self, program, folder):
        self.program, self.folder, self.faults = program, folder, []

    def inspect(self, name, *options):
        command = [self.program, "inspect", str(self.folder / name), "--json", *options]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            self.faults.append(f"{name}: inspect failed: {done.stderr.strip()}")
            return None
        return json.loads(done.stdout)

    def expect(self, name, what, found, expected):
        if found != expected:
            self.faults.append(f"{name}: {what}: {found!r}, expected {expected!r}")

    def multilayer(self, name, layer, layers, objects=OBJECTS):
        told = self.inspect(name, "--cryptomatte")
        if told is None:
            return
        self.expect(name, "profile", told["profile"]["id"], "blender")
        self.expect(name, "roles", set(told["roles"]), PASSES)
        self.expect(name, "layer", told["layer"], layer)
        self.expect(name, "layers", told["layers"], layers)
        found = set()
        for matte in told["cryptomattes"]:
            found |= set(matte.get("objects", {}))
        self.expect(name, "objects that are missing", objects - found, set())

    def run(self):
        self.multilayer("multi_0003.exr", "ViewLayer", ["ViewLayer"])
        self.multilayer("layers.exr", "Far", ["Far", "Near objects"], OBJECTS - {"Cube"})
        near = self.inspect("layers.exr", "--layer", "Near objects")
        if near:
            self.expect("layers.exr", "depth of Near objects", near["roles"]["depth"], ["Near objects.Depth.Z"])
        single = self.inspect("single.exr")
        if single:
            self.expect("single.exr", "roles", set(single["roles"]), {"color"})
        if (self.folder / "composite.exr").exists():
            self.multilayer("composite.exr", "Composite", ["Composite", "ViewLayer"])
        if (self.folder / "file_output.exr").exists():
            told = self.inspect("file_output.exr")
            if told:
                self.expect("file_output.exr", "roles", {"color", "depth", "velocity", "normal"} - set(told["roles"]),
                            set())
        self.addon()
        self.mask()

    def addon(self):
        """What the add-on wrote has every role, and the camera that the scene has."""
        name = "addon/capture.json"
        self.multilayer(name, "ViewLayer", ["ViewLayer"])
        told = self.inspect(name)
        if told:
            camera = told["camera"]
            self.expect(name, "focal length", camera.get("focal_length"), 50)
            self.expect(name, "sensor", camera.get("sensor_width"), 36)
            # Suzanne is at (-1, 0, 0.2), the camera at (0, -6, 1.5), turned by 1.4 rad: along its axis.
            along = 6 * math.sin(1.4) + 1.3 * math.cos(1.4)
            self.expect(name, "focus on Suzanne", round(camera.get("focus_distance", 0), 3), round(along, 3))

    def mask(self):
        """A mask by an object's name changes pixels of that object alone."""
        with tempfile.TemporaryDirectory() as folder:
            look = pathlib.Path(folder) / "look.json"
            look.write_text(json.dumps({"aftershade": 1, "steps": [
                {"effect": "color_grade", "params": {"exposure": 1}, "mask": {"object": ["Suzanne"]}}]}))
            done = subprocess.run([self.program, "run", str(look), str(self.folder / "multi_0003.exr"), "-o",
                                   folder + "/out.exr"], capture_output=True, text=True)
            if done.returncode != 0:
                self.faults.append(f"multi_0003.exr: a mask by name failed: {done.stderr.strip()}")


def main():
    check = Check(sys.argv[1], pathlib.Path(sys.argv[2]))
    check.run()
    for fault in check.faults:
        print(f"{check.folder.name}: {fault}")
    if not check.faults:
        print(f"{check.folder.name}: every file is read as Blender wrote it")
    sys.exit(1 if check.faults else 0)


main()
