"""Renders with the passes that Aftershade reads, and opens its page on the result. For Blender 4.2 and newer.

Install: Edit > Preferences > Add-ons > Install from Disk. The panel is in Properties > Output > Aftershade.
"""
import atexit
import json
import pathlib
import re
import shutil
import subprocess
import tempfile

import bpy

bl_info = {
    "name": "Aftershade",
    "description": "Render the passes that Aftershade reads, and open its page on them",
    "author": "The Aftershade project",
    "version": (1, 0, 0),
    "blender": (4, 2, 0),
    "location": "Properties > Output > Aftershade",
    "category": "Render",
}

# View layers have them as use_pass_NAME.
PASSES = ("combined", "z", "vector", "normal", "position", "object_index", "diffuse_direct", "diffuse_indirect",
          "diffuse_color", "emit", "cryptomatte_object", "cryptomatte_material")
MARK = "// Written by the Aftershade add-on, which replaces it at each render. Without this line it stays as it is.\n"


def tick_passes(scene):
    for layer in scene.view_layers:
        for name in PASSES:
            setattr(layer, "use_pass_" + name, True)


def sensor_width(scene, camera):
    """Of the part of the sensor that the picture's width shows, in mm."""
    render = scene.render
    width, height = render.resolution_x * render.pixel_aspect_x, render.resolution_y * render.pixel_aspect_y
    if camera.sensor_fit == "VERTICAL":
        return camera.sensor_height * width / height
    if camera.sensor_fit == "AUTO" and height > width:
        return camera.sensor_width * width / height
    return camera.sensor_width


def focus_distance(holder):
    lens = holder.data.dof
    if lens.focus_object is None:
        return lens.focus_distance
    return -(holder.matrix_world.inverted() @ lens.focus_object.matrix_world.translation).z


def camera_values(scene):
    """The "camera" of capture.json: what the files do not hold."""
    holder = scene.camera
    if holder is None or holder.type != "CAMERA" or holder.data.type != "PERSP":
        return {}
    camera = holder.data
    values = {"focal_length": round(camera.lens, 4), "sensor_width": round(sensor_width(scene, camera), 4)}
    if camera.dof.use_dof:
        values["focus_distance"] = round(max(focus_distance(holder), 0.001), 4)
        values["f_number"] = round(camera.dof.aperture_fstop, 4)
        values["blades"] = camera.dof.aperture_blades if camera.dof.aperture_blades >= 3 else 0
    if scene.render.use_motion_blur:
        values["shutter_angle"] = round(scene.render.motion_blur_shutter * 360, 4)
    return values


def capture_text(scene, name):
    render = scene.render
    document = {"aftershade": 1, "profile": "blender", "frames": f"{name}_####.exr",
                "fps": round(render.fps / render.fps_base, 4)}
    camera = camera_values(scene)
    if camera:
        document["camera"] = camera
    return MARK + json.dumps(document, indent=2) + "\n"


class Settings:
    """Changes settings, and gives them back."""

    def __init__(self):
        self.kept = []

    def set(self, owner, **values):
        # All are kept before any changes: with the file's format Blender changes its bits.
        self.kept += [(owner, name, getattr(owner, name)) for name in values]
        for name, value in values.items():
            setattr(owner, name, value)

    def give_back(self):
        # In the order of change: a format's bits are refused while another format is set.
        for owner, name, value in self.kept:
            setattr(owner, name, value)
        self.kept.clear()


def set_up(settings, scene, pattern, is_animation):
    """Sharp frames: the lens and the shutter are Aftershade's, and Blender renders no Vector with motion blur."""
    render, image = scene.render, scene.render.image_settings
    settings.set(render, use_motion_blur=False, use_file_extension=True, filepath=pattern)
    if scene.camera is not None and scene.camera.type == "CAMERA":
        settings.set(scene.camera.data.dof, use_dof=False)
    media = {"media_type": "MULTI_LAYER_IMAGE"} if hasattr(image, "media_type") else {}  # from 5.0 on it limits the formats
    settings.set(image, **media, file_format="OPEN_EXR_MULTILAYER", color_depth="16", exr_codec="ZIP")
    if not is_animation:
        settings.set(scene, frame_start=scene.frame_current, frame_end=scene.frame_current)


def program_of(context):
    """Path of the program; None where there is none."""
    addon = context.preferences.addons.get(__name__)
    return shutil.which(bpy.path.abspath(addon.preferences.program) if addon else "aftershade")


class Server:
    """The one page: `aftershade serve` of the last render."""

    process = None

    @classmethod
    def start(cls, program, capture):
        cls.stop()
        cls.process = subprocess.Popen([program, "serve", str(capture), "--open"], stdin=subprocess.DEVNULL)

    @classmethod
    def stop(cls):
        if cls.process is not None and cls.process.poll() is None:
            cls.process.terminate()
        cls.process = None


def render_all(settings, open_page):
    """Gives the settings back after the last frame, and opens the page on what was rendered."""
    if bpy.app.background:
        try:
            bpy.ops.render.render(animation=True)
        finally:
            settings.give_back()
        if open_page:
            open_page()
        return
    handlers = bpy.app.handlers

    # Handlers run in the thread that renders, where no setting may change. A timer runs in the main thread.
    def end_with(*work):
        def handler(*_):
            handlers.render_complete.remove(complete)
            handlers.render_cancel.remove(cancelled)
            for one in work:
                bpy.app.timers.register(one)

        return handler

    complete = end_with(settings.give_back, *([open_page] if open_page else []))
    cancelled = end_with(settings.give_back)
    handlers.render_complete.append(complete)
    handlers.render_cancel.append(cancelled)
    if "CANCELLED" in bpy.ops.render.render("INVOKE_DEFAULT", animation=True):  # another render runs
        cancelled()


class AFTERSHADE_Preferences(bpy.types.AddonPreferences):
    bl_idname = __name__
    program: bpy.props.StringProperty(name="Program", default="aftershade", subtype="FILE_PATH",
                                      description="Name or path of the program aftershade")

    def draw(self, context):
        self.layout.prop(self, "program")


class AFTERSHADE_OT_passes(bpy.types.Operator):
    """Tick the passes that Aftershade reads, in every view layer"""

    bl_idname = "aftershade.passes"
    bl_label = "Tick the passes"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        tick_passes(context.scene)
        return {"FINISHED"}


class AFTERSHADE_OT_render(bpy.types.Operator):
    """Tick the passes, render without depth of field and motion blur to OpenEXR MultiLayer, and open the page"""

    bl_idname = "aftershade.render"
    bl_label = "Render and open the page"

    is_animation: bpy.props.BoolProperty(name="Animation", description="All frames of the scene; else the current one")
    opens_page: bpy.props.BoolProperty(name="Open the page", default=True)

    def execute(self, context):
        scene = context.scene
        program = program_of(context)
        if self.opens_page and program is None:
            self.report({"ERROR"}, "The program aftershade is not on PATH: set its path in Preferences > Add-ons > Aftershade")
            return {"CANCELLED"}
        if scene.camera is None:
            self.report({"ERROR"}, "The scene has no camera: add one (Add > Camera)")
            return {"CANCELLED"}
        folder = pathlib.Path(bpy.path.abspath(scene.aftershade_folder))
        if scene.aftershade_folder.startswith("//") and not bpy.data.filepath:
            folder = pathlib.Path(tempfile.mkdtemp(prefix="aftershade_"))  # an unsaved file has no folder
        folder.mkdir(parents=True, exist_ok=True)
        name = re.sub(r"[^A-Za-z0-9-]+", "_", pathlib.Path(bpy.data.filepath).stem or scene.name)
        capture = folder / "capture.json"
        self.write_capture(capture, capture_text(scene, name))
        tick_passes(scene)
        settings = Settings()
        set_up(settings, scene, str(folder / f"{name}_####"), self.is_animation)
        render_all(settings, (lambda: Server.start(program, capture)) if self.opens_page else None)
        return {"FINISHED"}

    def write_capture(self, file, text):
        if file.exists() and not file.read_text(encoding="utf-8").startswith(MARK):
            self.report({"WARNING"}, f"{file} is not the add-on's: it stays as it is")
        else:
            file.write_text(text, encoding="utf-8")


class AFTERSHADE_PT_output(bpy.types.Panel):
    bl_label = "Aftershade"
    bl_idname = "AFTERSHADE_PT_output"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "output"

    def draw(self, context):
        column = self.layout.column()
        column.prop(context.scene, "aftershade_folder")
        column.operator("aftershade.passes")
        column.operator("aftershade.render", text="Render this frame").is_animation = False
        column.operator("aftershade.render", text="Render the animation").is_animation = True


CLASSES = (AFTERSHADE_Preferences, AFTERSHADE_OT_passes, AFTERSHADE_OT_render, AFTERSHADE_PT_output)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.aftershade_folder = bpy.props.StringProperty(
        name="Folder", default="//aftershade/", subtype="DIR_PATH", description="Where the frames and capture.json go")
    atexit.register(Server.stop)


def unregister():
    atexit.unregister(Server.stop)
    Server.stop()
    del bpy.types.Scene.aftershade_folder
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
