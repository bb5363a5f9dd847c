"""Run inside Blender 3.4 by tests/bench/motion-against-blender: one EXR through the compositor's Vector Blur node, into another EXR.
With `node` for `whole` it writes nothing, and says how long the compositor took with the node and without it.

    blender -b --factory-startup --python motion_blender.py -- whole IN.exr OUT.exr SAMPLES WIDTH HEIGHT THREADS
"""
import pathlib
import sys

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import vector_blur_settings as settings  # noqa: E402

mode, source, target, samples, width, height, threads = settings.words_after_dashes()
scene = bpy.context.scene
settings.set_up_scene(scene, target, width, height, threads)
scene.use_nodes = True
tree = scene.node_tree
tree.nodes.clear()
blur = settings.add_nodes(tree, source)
blur.samples = int(samples)
blur.factor = 1  # best against the truth, of those tried
result = tree.nodes.new("CompositorNodeComposite")
tree.links.new(blur.outputs["Image"], result.inputs["Image"])
settings.run(mode, blur)
