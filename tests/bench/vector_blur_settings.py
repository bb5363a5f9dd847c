"""What motion_blender.py and motion_bpy.py share: settings of the renderer and of the output, and the times of the node."""
import sys
import time

import bpy


def words_after_dashes():
    return sys.argv[sys.argv.index("--") + 1:]


def set_up_scene(scene, target, width, height, threads):
    render = scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = int(width), int(height), 100
    render.threads_mode, render.threads = "FIXED", int(threads)
    render.use_sequencer = False
    scene.view_settings.view_transform = "Raw"
    settings = render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth, settings.exr_codec = "OPEN_EXR", "RGBA", "16", "ZIP"
    render.filepath = target
    render.use_file_extension = False


def add_nodes(tree, source):
    """The file and the blur, linked; the blur's settings differ by version."""
    image = tree.nodes.new("CompositorNodeImage")
    image.image = bpy.data.images.load(source)
    blur = tree.nodes.new("CompositorNodeVecBlur")
    tree.links.new(image.outputs["Combined"], blur.inputs["Image"])
    tree.links.new(image.outputs["Depth"], blur.inputs["Z"])
    tree.links.new(image.outputs["Vector"], blur.inputs["Speed"])
    return blur


def run(mode, blur):
    """`whole` writes the picture; `node` writes nothing, and prints how long the compositor took with the node and without it."""
    if mode == "whole":
        bpy.ops.render.render(write_still=True)
        return
    bpy.ops.render.render()  # loads the file
    spent = []
    for muted in False, True:
        blur.mute = muted
        start = time.monotonic()
        bpy.ops.render.render()
        spent.append(time.monotonic() - start)
    print("compositor: %.3f s with the node, %.3f s without" % tuple(spent))
