"""Renders one small scene with the Blender that `import bpy` finds, into every kind of OpenEXR file that it writes.

    python render_scene.py FOLDER

writes to FOLDER: multi_0003.exr and multi_0004.exr (multilayer, every pass that Aftershade reads, Cryptomatte),
layers.exr (two view layers), single.exr (one layer), composite.exr (multilayer with a compositor's result) and
file_output.exr (by a File Output node). What a version cannot write it leaves out and tells.
"""
import pathlib
import sys

import bpy

FRAMES = (3, 4)


def add_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    bpy.ops.mesh.primitive_plane_add(size=20, location=(0, 0, -1))
    bpy.context.object.name = "Floor"
    bpy.ops.mesh.primitive_monkey_add(location=(-1, 0, 0.2))
    bpy.context.object.name = "Suzanne"
    bpy.context.object.pass_index = 7
    bpy.ops.mesh.primitive_cube_add(size=1.2, location=(1.2, 0.4, 0))
    cube = bpy.context.object
    cube.name, cube.pass_index = "Cube", 300
    for frame, x in ((1, 0.6), (8, 2.0)):
        cube.location.x = x
        cube.keyframe_insert("location", frame=frame)
    bpy.ops.object.light_add(type="AREA", location=(2, -3, 5))
    bpy.context.object.data.energy = 500
    bpy.ops.object.camera_add(location=(0, -6, 1.5), rotation=(1.4, 0, 0))
    scene.camera = bpy.context.object
    return scene


def set_up(scene):
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 4
    scene.cycles.use_denoising = False
    scene.render.resolution_x, scene.render.resolution_y = 160, 90
    scene.render.resolution_percentage = 100
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.render.film_transparent = False


PASSES = ("combined", "z", "mist", "position", "normal", "vector", "uv", "object_index", "material_index",
          "diffuse_direct", "diffuse_indirect", "diffuse_color", "glossy_direct", "glossy_indirect", "glossy_color",
          "emit", "environment", "cryptomatte_object", "cryptomatte_material")


def use_passes(layer):
    for name in PASSES:
        if hasattr(layer, "use_pass_" + name):
            setattr(layer, "use_pass_" + name, True)


def set_format(settings, file_format):
    if hasattr(settings, "media_type"):  # from 5.0 on it limits the formats
        settings.media_type = "MULTI_LAYER_IMAGE" if file_format.endswith("MULTILAYER") else "IMAGE"
    settings.file_format = file_format
    settings.color_depth = "16"
    settings.exr_codec = "ZIP"


def render(scene, path, file_format="OPEN_EXR_MULTILAYER", frame=FRAMES[0]):
    set_format(scene.render.image_settings, file_format)
    scene.render.filepath = str(path)
    scene.frame_set(frame)
    bpy.ops.render.render(write_still=True)


def node_tree(scene):
    """The compositor's nodes, and the node that takes its result."""
    if hasattr(scene, "compositing_node_group"):  # from 5.0 on
        tree = bpy.data.node_groups.new("Compositor", "CompositorNodeTree")
        scene.compositing_node_group = tree
        tree.interface.new_socket(name="Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        return tree, tree.nodes.new("NodeGroupOutput")
    scene.use_nodes = True
    tree = scene.node_tree
    tree.nodes.clear()
    return tree, tree.nodes.new("CompositorNodeComposite")


def render_composite(scene, folder):
    tree, result = node_tree(scene)
    layers = tree.nodes.new("CompositorNodeRLayers")
    flip = tree.nodes.new("CompositorNodeFlip")
    tree.links.new(layers.outputs["Image"], flip.inputs[0])
    tree.links.new(flip.outputs[0], result.inputs[0])
    render(scene, folder / "composite.exr")
    tree.links.new(layers.outputs["Image"], result.inputs[0])

    output = tree.nodes.new("CompositorNodeOutputFile")
    wanted = {"Image": "RGBA", "Depth": "FLOAT", "Vector": "VECTOR", "Normal": "VECTOR"}
    if hasattr(output, "file_output_items"):  # from 5.0 on
        output.directory, output.file_name = str(folder), "file_output_"
        output.format.media_type = "MULTI_LAYER_IMAGE"
        for name, kind in wanted.items():
            output.file_output_items.new(kind, name)
    else:
        output.base_path = str(folder / "file_output_")
        output.layer_slots.clear() if hasattr(output, "layer_slots") else None
    set_format(output.format, "OPEN_EXR_MULTILAYER")
    if not hasattr(output, "file_output_items"):
        output.layer_slots.clear()
        for name in wanted:
            output.layer_slots.new(name)
    for name in wanted:
        if name in layers.outputs:
            tree.links.new(layers.outputs[name], output.inputs[name])
    render(scene, folder / "unused.exr")
    (folder / "unused.exr").unlink()
    written = sorted(folder.glob("file_output_*"))
    written[-1].rename(folder / "file_output.exr")


def add_second_layer(scene):
    first = scene.view_layers[0]
    first.name = "Far"
    second = scene.view_layers.new("Near objects")
    use_passes(second)
    near = bpy.data.collections.new("Near")
    scene.collection.children.link(near)
    cube = bpy.data.objects["Cube"]
    near.objects.link(cube)
    scene.collection.objects.unlink(cube)
    first.layer_collection.children["Near"].exclude = True


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    scene = add_scene()
    set_up(scene)
    use_passes(scene.view_layers[0])
    for frame in FRAMES:
        render(scene, folder / f"multi_{frame:04}.exr", frame=frame)
    render(scene, folder / "single.exr", "OPEN_EXR")
    try:
        render_composite(scene, folder)
    except (AttributeError, RuntimeError, TypeError, IndexError, KeyError) as error:
        print(f"{bpy.app.version_string}: no file of the compositor: {error}", file=sys.stderr)
    if hasattr(scene, "compositing_node_group"):
        scene.compositing_node_group = None
    else:
        scene.use_nodes = False
    add_second_layer(scene)
    render(scene, folder / "layers.exr")


if __name__ == "__main__":
    main()
