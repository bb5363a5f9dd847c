"""Writes scenes/meshes/head.glb and bat.glb. Run with Blender 3.4 (Debian 12's, with python3-numpy for its exporter):

    blender -b --factory-startup --python scripts/make-mesh-fixtures.py
"""
import pathlib

import bpy

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "scenes" / "meshes"
HEAD_WIDTH_M = 2.0

# The right half of the bat (x > 0), glTF's axes: x, y up, z towards who looks at it. The rim lies in both sheets, front and back;
# chest and palm stand out of it by their thickness.
RIM = {
    "head": (0.0, 0.09), "ear": (0.045, 0.15), "neck": (0.07, 0.07), "wrist": (0.24, 0.13), "tip": (0.5, 0.03),
    "notch_1": (0.37, -0.01), "finger": (0.30, -0.13), "notch_2": (0.17, -0.06), "tail": (0.0, -0.17),
}
INNER = {"chest": (0.0, 0.0, 0.05), "palm": (0.20, 0.03, 0.012)}
# Counter-clockwise seen from +z.
HALF = [
    ("chest", "ear", "head"), ("chest", "neck", "ear"), ("chest", "tail", "notch_2"),
    ("palm", "neck", "chest"), ("palm", "wrist", "neck"), ("palm", "tip", "wrist"), ("palm", "notch_1", "tip"),
    ("palm", "finger", "notch_1"), ("palm", "notch_2", "finger"), ("palm", "chest", "notch_2"),
]
SWEEP_PER_M = 0.4  # the wings bend back by this times x^2


def blender_from_gltf(x, y, z):
    return (x, -z, y)


def fresh_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)


def export(name):
    FOLDER.mkdir(parents=True, exist_ok=True)
    bpy.ops.export_scene.gltf(filepath=str(FOLDER / name), export_format="GLB", export_yup=True, export_texcoords=True,
                              export_normals=True, export_materials="NONE", export_animations=False)


def make_head():
    fresh_scene()
    bpy.ops.mesh.primitive_monkey_add(size=2)
    head = bpy.context.object
    head.name = head.data.name = "head"
    for face in head.data.polygons:
        face.use_smooth = True
    subdivide = head.modifiers.new("subdivide", "SUBSURF")
    subdivide.levels = 1
    bpy.ops.object.modifier_apply(modifier="subdivide")
    head.scale = [HEAD_WIDTH_M / head.dimensions.x] * 3
    bpy.ops.object.transform_apply(scale=True)
    export("head.glb")


def make_bat():
    fresh_scene()
    vertices, faces, uvs, index = [], [], [], {}

    def vertex(name, side, front):
        x, y = (RIM.get(name) or INNER[name])[:2]
        thickness = INNER[name][2] if name in INNER else 0.0
        point = (side * x, y, front * thickness - SWEEP_PER_M * x * x)
        if point not in index:
            index[point] = len(vertices)
            vertices.append(blender_from_gltf(*point))
        return index[point]

    for front in (1, -1):
        for side in (1, -1):
            for triangle in HALF:
                corners = triangle if side * front > 0 else triangle[::-1]
                faces.append([vertex(name, side, front) for name in corners])
                for name in corners:  # the front in the left half of the texture, the back in the right; v up, as Blender has it
                    x, y = (RIM.get(name) or INNER[name])[:2]
                    uvs.append((0.25 + 0.5 * side * x + (0.0 if front > 0 else 0.5), 0.5 + y))
    mesh = bpy.data.meshes.new("bat")
    mesh.from_pydata(vertices, [], faces)
    layer = mesh.uv_layers.new(name="UVMap")
    for loop, uv in zip(layer.data, uvs):
        loop.uv = uv
    mesh.validate()
    bat = bpy.data.objects.new("bat", mesh)
    bpy.context.collection.objects.link(bat)
    export("bat.glb")


make_head()
make_bat()
