"""As motion_blender.py, for the package bpy of Blender 5, whose compositor is a node group.

    python motion_bpy.py -- whole IN.exr OUT.exr SAMPLES WIDTH HEIGHT THREADS CPU|GPU
"""
import bpy

import vector_blur_settings as settings

mode, source, target, samples, width, height, threads, device = settings.words_after_dashes()
bpy.ops.wm.read_factory_settings()
scene = bpy.context.scene
settings.set_up_scene(scene, target, width, height, threads)
scene.render.compositor_device = device
tree = scene.compositing_node_group = bpy.data.node_groups.new("vector blur", "CompositorNodeTree")
tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
blur = settings.add_nodes(tree, source)
blur.inputs["Samples"].default_value = int(samples)
blur.inputs["Shutter"].default_value = 0.5  # of a frame; better against the truth than 1
result = tree.nodes.new("NodeGroupOutput")
tree.links.new(blur.outputs["Image"], result.inputs["Image"])
settings.run(mode, blur)
