"""Renders frame 3 with the add-on in the Blender that `import bpy` finds, and has it open the page.

    python try_addon.py ADDON PROGRAM FOLDER

checks what the add-on changed and gave back. check_files.py reads the file that it writes to FOLDER/addon.
"""
import importlib.util
import os
import pathlib
import stat
import sys
import time

import bpy
import render_scene


def loaded(path):
    spec = importlib.util.spec_from_file_location("aftershade_for_blender", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    module.register()
    return module


def stand_in(folder, program):
    """A program of the name on PATH that runs the true one without --open, which needs a desktop."""
    words = folder / "bin/aftershade"
    words.parent.mkdir(parents=True, exist_ok=True)
    words.write_text(f'#!/bin/sh\n[ "$3" = --open ] && exec "{program}" "$1" "$2" >"{folder}/address"\n', encoding="utf-8")
    words.chmod(words.stat().st_mode | stat.S_IXUSR)
    os.environ["PATH"] = f"{words.parent}:{os.environ['PATH']}"


def kept(scene):
    """What the add-on changes for the render and gives back."""
    render = scene.render
    return (render.use_motion_blur, scene.camera.data.dof.use_dof, render.filepath, scene.frame_start, scene.frame_end,
            render.image_settings.file_format, render.image_settings.color_depth)


def main():
    addon, program, folder = sys.argv[1], pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3]).resolve()
    scene = render_scene.add_scene()
    render_scene.set_up(scene)
    scene.frame_set(3)
    render = scene.render
    render.use_motion_blur, scene.camera.data.dof.use_dof = True, True
    scene.camera.data.dof.focus_object = bpy.data.objects["Suzanne"]
    render.filepath = "kept"
    stand_in(folder, program)
    module = loaded(addon)
    scene.aftershade_folder = str(folder / "addon")
    before = kept(scene)
    assert bpy.ops.aftershade.render(is_animation=False) == {"FINISHED"}
    assert kept(scene) == before, (kept(scene), before)
    missing = [name for name in module.PASSES if not getattr(scene.view_layers[0], "use_pass_" + name)]
    assert not missing, missing
    address = folder / "address"
    for _ in range(300):
        if address.exists() and "http://127.0.0.1:" in address.read_text(encoding="utf-8"):
            break
        time.sleep(0.1)
    else:
        raise AssertionError("no page was opened")
    process = module.Server.process
    module.unregister()
    assert process.wait(timeout=30) is not None
    print("the add-on works", flush=True)


main()
