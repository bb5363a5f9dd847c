"""What a user of moderngl and OpenImageIO writes for one shader over a sequence: reads RGBA, draws, writes half ZIP.

    moderngl_chain.py FRAMES OUT FIRST_CHANNEL        FRAMES and OUT hold {}, which is the frame's number
"""
import sys

import moderngl
import numpy as np
import OpenImageIO as oiio

from measure.measures import Array

VERTEX = """#version 330
void main() { gl_Position = vec4(gl_VertexID % 2 * 4 - 1, gl_VertexID / 2 * 4 - 1, 0, 1); }"""
FRAGMENT = """#version 330
uniform sampler2D color;
uniform float gain;
out vec4 out_color;
void main() { vec4 c = texelFetch(color, ivec2(gl_FragCoord.xy), 0); out_color = vec4(c.rgb * gain, c.a); }"""


def read(path: str, first_name: str) -> Array:
    file = oiio.ImageInput.open(path)
    spec = file.spec()
    first = spec.channelnames.index(first_name)
    pixels = file.read_image(0, 0, first, first + 4, "float")
    file.close()
    return np.ascontiguousarray(pixels)


def write(path: str, pixels: Array) -> None:
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 4, "half")
    spec.attribute("compression", "zip")
    out = oiio.ImageOutput.create(path)
    out.open(path, spec)
    out.write_image(pixels)
    out.close()


def main() -> None:
    frames, target, first_name = sys.argv[1:4]
    gl = moderngl.create_standalone_context(backend="egl")
    program = gl.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
    program["gain"] = 1.5
    triangle = gl.vertex_array(program, [])
    texture = None
    for number in range(1, 101):
        pixels = read(frames.format(f"{number:04}"), first_name)
        if texture is None:
            size = pixels.shape[1], pixels.shape[0]
            texture = gl.texture(size, 4, dtype="f4")
            picture = gl.texture(size, 4, dtype="f4")
            framebuffer = gl.framebuffer([picture])
        texture.write(pixels)
        texture.use()
        framebuffer.use()
        triangle.render(moderngl.TRIANGLES, vertices=3)
        result = np.frombuffer(framebuffer.read(components=4, dtype="f4"), np.float32).reshape(size[1], size[0], 4)
        write(target.format(f"{number:04}"), result)


main()
