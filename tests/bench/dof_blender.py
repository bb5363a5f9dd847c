"""Run inside Blender by tests/bench/dof-against-blender: one EXR through the compositor's Defocus node, into another EXR.

    blender -b --factory-startup --python dof_blender.py -- IN.exr OUT.exr WIDTH HEIGHT THREADS
"""
import sys

import bpy

source, target, width, height, threads = sys.argv[sys.argv.index("--") + 1:]
scene = bpy.context.scene
render = scene.render
render.resolution_x, render.resolution_y, render.resolution_percentage = int(width), int(height), 100
render.threads_mode, render.threads = "FIXED", int(threads)
render.use_sequencer = False
scene.use_nodes = True
scene.view_settings.view_transform = "Raw"

# Defocus takes focus and focal length from the scene's camera. What is rendered is the compositor alone.
lens = scene.camera.data
lens.lens, lens.sensor_width, lens.dof.focus_distance, lens.dof.use_dof = 50, 36, 6.4, True

tree = scene.node_tree
tree.nodes.clear()
image = tree.nodes.new("CompositorNodeImage")
image.image = bpy.data.images.load(source)
defocus = tree.nodes.new("CompositorNodeDefocus")
defocus.use_zbuffer = True  # metres of depth and the camera's focus, not a hand-made mask of radii
# The node's f-stop is no lens': its radius at infinity is 1/4 * lens / (aspect * sensor) / f_stop * height / (sensor / 2 / lens) /
# focus in metres (COM_ConvertDepthToRadiusOperation). This one gives the radius of f/0.25 through a lens, as a user finds by
# eye; with 0.25 every pixel but those in focus would be cut to blur_max, which takes three times as long.
lens_radius_px = 0.5 * (50 / 0.25) * 50 / 6400 * int(width) / 36
aspect = int(height) / int(width)
defocus.f_stop = 0.25 * 50 / (aspect * 36) * int(height) / (18 / 50) / 6.4 / lens_radius_px
defocus.bokeh = "HEXAGON"
defocus.blur_max = 64
defocus.use_preview = False
defocus.scene = scene
result = tree.nodes.new("CompositorNodeComposite")
tree.links.new(image.outputs["Combined"], defocus.inputs["Image"])
tree.links.new(image.outputs["Depth"], defocus.inputs["Z"])
tree.links.new(defocus.outputs["Image"], result.inputs["Image"])

settings = render.image_settings
settings.file_format, settings.color_mode, settings.color_depth, settings.exr_codec = "OPEN_EXR", "RGBA", "16", "ZIP"
render.filepath = target
render.use_file_extension = False
bpy.ops.render.render(write_still=True)
