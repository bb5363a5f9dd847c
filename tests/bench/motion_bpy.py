"""One EXR through the compositor's Vector Blur node, into another EXR; as motion_blender.py, for the package bpy of Blender 5, whose
compositor is a node group. With `node` for `whole` it writes nothing, and says how long the compositor took with the node and
without it.

    python motion_bpy.py -- whole IN.exr OUT.exr SAMPLES WIDTH HEIGHT THREADS CPU|GPU
"""
import sys
import time

import bpy

mode, source, target, samples, width, height, threads, device = sys.argv[sys.argv.index("--") + 1:]
bpy.ops.wm.read_factory_settings()
scene = bpy.context.scene
render = scene.render
render.resolution_x, render.resolution_y, render.resolution_percentage = int(width), int(height), 100
render.threads_mode, render.threads = "FIXED", int(threads)
render.use_sequencer = False
render.compositor_device = device
scene.view_settings.view_transform = "Raw"

tree = scene.compositing_node_group = bpy.data.node_groups.new("vector blur", "CompositorNodeTree")
tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
image = tree.nodes.new("CompositorNodeImage")
image.image = bpy.data.images.load(source)
blur = tree.nodes.new("CompositorNodeVecBlur")
blur.inputs["Samples"].default_value = int(samples)
blur.inputs["Shutter"].default_value = 0.5  # of a frame; better against the truth than 1
result = tree.nodes.new("NodeGroupOutput")
tree.links.new(image.outputs["Combined"], blur.inputs["Image"])
tree.links.new(image.outputs["Depth"], blur.inputs["Z"])
tree.links.new(image.outputs["Vector"], blur.inputs["Speed"])
tree.links.new(blur.outputs["Image"], result.inputs["Image"])

settings = render.image_settings
settings.file_format, settings.color_mode, settings.color_depth, settings.exr_codec = "OPEN_EXR", "RGBA", "16", "ZIP"
render.filepath = target
render.use_file_extension = False

if mode == "whole":
    bpy.ops.render.render(write_still=True)
else:
    bpy.ops.render.render()  # loads the file
    spent = []
    for muted in False, True:
        blur.mute = muted
        start = time.monotonic()
        bpy.ops.render.render()
        spent.append(time.monotonic() - start)
    print("compositor: %.3f s with the node, %.3f s without" % tuple(spent))
