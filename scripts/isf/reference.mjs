// reference.mjs JOBS OUT: ISF files through the format's own renderer in Chromium on software GL. JOBS is a list of
// {"name", "fragment", "vertex", "values", "images"} with a width, a height and frames; OUT gets for each job the frames' RGBA
// bytes from the top, in base64, or a reason. `fixes` puts five faults of that renderer right, see below.
import { readFileSync, writeFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import { basename, dirname, join, resolve } from "node:path";

const [, , jobsFile, outFile] = process.argv;
const { width, height, fps, frames, picture, jobs, fixes, mesa } = JSON.parse(readFileSync(jobsFile));
const modules = process.env.AFTERSHADE_ISF_MODULES ?? "build/isf-modules";
const require = createRequire(join(resolve(modules), "/"));
const { chromium } = require("playwright-core");
const root = dirname(dirname(require.resolve("interactive-shader-format")));

// The package has no build that a page can load: each of its files becomes a function of (module, exports, require).
const sources = {};
for (const folder of ["lib", "vendor"])
  for (const file of readdirSync(join(root, folder)))
    if (file.endsWith(".js")) sources[basename(file, ".js")] = readFileSync(join(root, folder, file), "utf8");

// Two software GLs: Mesa's has the sines that noise is made of here, SwiftShader filters textures of 8 bits as exactly as floats.
const kMesa = ["--use-gl=angle", "--use-angle=gl-egl", "--ignore-gpu-blocklist"];
const kSwiftShader = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const browser = await chromium.launch({
  executablePath: process.env.AFTERSHADE_CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--force-color-profile=srgb", ...(mesa ? kMesa : kSwiftShader)],
  env: { ...process.env, LIBGL_ALWAYS_SOFTWARE: "1", EGL_PLATFORM: "surfaceless" },
});
const page = await browser.newPage();
await page.evaluate(
  ([texts, fixed]) => {
    const loaded = {};
    const load = (path) => {
      const name = path.split("/").pop().replace(/\.js$/, "");
      if (!loaded[name]) {
        const module = (loaded[name] = { exports: {} });
        new Function("module", "exports", "require", texts[name])(module, module.exports, load);
      }
      return loaded[name].exports;
    };
    window.isf = load("main");
    window.isf.Texture = load("ISFTexture");
    if (!fixed) return;
    // Fault 1: passes read what the last frame, and not this one, has written. Fault 2: a macro's arguments end at the first ")".
    const draw = window.isf.Renderer.prototype.draw;
    window.isf.Renderer.prototype.draw = function (destination) {
      const { gl, renderBuffers } = this;
      // Fault 4: in the first frame, buffers that no pass has drawn yet have no size.
      gl.activeTexture(gl.TEXTURE15);
      this.model.passes.forEach((pass) => {
        if (pass.target) pass.buffer.setSize(...["width", "height"].map((side) => this.evaluateSize(destination, pass[side])));
      });
      const arrays = gl.drawArrays.bind(gl);
      const flips = renderBuffers.map((buffer) => buffer.flip);
      let pass = 0;
      gl.drawArrays = (...words) => {
        arrays(...words);
        const buffer = renderBuffers[pass++];
        if (!buffer || !buffer.name) return;
        flips[pass - 1].call(buffer);
        const location = this.program.getUniformLocation(buffer.name);
        if (location === null) return;
        const unit = gl.getUniform(this.program.program, location);
        gl.activeTexture(gl.TEXTURE0 + unit);
        gl.bindTexture(gl.TEXTURE_2D, buffer.readTexture().texture);
        gl.activeTexture(gl.TEXTURE15); // of which draw() takes the texture away
      };
      for (const buffer of renderBuffers) buffer.flip = () => {};
      try {
        draw.call(this, destination);
      } finally {
        delete gl.drawArrays;
        for (const buffer of renderBuffers) delete buffer.flip;
      }
    };
    window.isf.Parser.prototype.replaceSpecialFunctions = (text) => {
      const one = (source, name, write) => {
        for (let at; (at = source.search(new RegExp(`\\b${name}\\s*\\(`))) >= 0; ) {
          const open = source.indexOf("(", at),
            parts = [""];
          let depth = 1,
            end = open;
          while (depth > 0 && ++end < source.length) {
            const c = source[end];
            depth += c === "(" ? 1 : c === ")" ? -1 : 0;
            if (c === "," && depth === 1) parts.push("");
            else if (depth > 0) parts[parts.length - 1] += c;
          }
          source = source.slice(0, at) + write(...parts.map((part) => part.trim())) + source.slice(end + 1);
        }
        return source;
      };
      for (const name of ["IMG_THIS_PIXEL", "IMG_THIS_NORM_PIXEL"])
        text = one(text, name, (image) => `texture2D(${image}, isf_FragNormCoord)`);
      text = one(text, "IMG_PIXEL", (image, at) => `texture2D(${image}, (${at}) / _${image}_imgSize)`);
      text = one(text, "IMG_NORM_PIXEL", (image, at) => `texture2D(${image}, ${at})`);
      return one(text, "IMG_SIZE", (image) => `_${image}_imgSize`);
    };
  },
  [sources, fixes],
);

const results = {};
for (const job of jobs)
  results[job.name] = await page.evaluate(
    async ([task, size, rate, wanted, pixels, fixed]) => {
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = size;
      const gl = canvas.getContext("webgl", { antialias: false, premultipliedAlpha: false, preserveDrawingBuffer: true });
      const bytes = Uint8ClampedArray.from(atob(pixels), (c) => c.charCodeAt(0));
      const input = document.createElement("canvas");
      [input.width, input.height] = size;
      input.getContext("2d").putImageData(new ImageData(bytes, size[0], size[1]), 0, 0);
      const clock = Date.now;
      let now = 0; // large ones would round
      Date.now = () => now;
      const errors = [],
        log = console.log;
      console.log = console.error = (...words) => errors.push(words.join(" "));
      try {
        // Fault 3: it asks for floats and does not turn them on.
        if (fixed) for (const name of ["OES_texture_float", "OES_texture_float_linear", "WEBGL_color_buffer_float"]) gl.getExtension(name);
        const renderer = new window.isf.Renderer(gl);
        renderer.loadSource(task.fragment, task.vertex ?? undefined);
        if (!renderer.valid) {
          const error = renderer.error;
          return { reason: (error && (error.message || String(error))) || "not valid" };
        }
        for (const [name, value] of Object.entries(task.values)) renderer.setValue(name, value);
        // Fault 5: it does not load what the file imports.
        const imports = {};
        if (fixed) gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
        for (const [name, png] of Object.entries(fixed ? task.imports : {})) {
          imports[name] = new Image();
          imports[name].src = `data:image/png;base64,${png}`;
          await imports[name].decode();
          renderer.uniforms[name].texture = new window.isf.Texture({}, renderer.contextState);
        }
        const pictures = {};
        for (let frame = 0; frame <= Math.max(...wanted); ++frame) {
          now = (1000 * frame) / rate;
          gl.bindFramebuffer(gl.FRAMEBUFFER, null);
          gl.clearColor(0, 0, 0, 0);
          gl.clear(gl.COLOR_BUFFER_BIT);
          // draw() gives its buffers the first units, those of images too that were set before; a video sets them in each frame.
          renderer.contextState.textureIndex = renderer.renderBuffers.length;
          for (const name of task.images) renderer.setValue(name, input);
          for (const [name, image] of Object.entries(imports)) renderer.setValue(name, image);
          renderer.draw(canvas);
          if (!wanted.includes(frame)) continue;
          const found = new Uint8Array(4 * size[0] * size[1]);
          gl.bindFramebuffer(gl.FRAMEBUFFER, null);
          gl.readPixels(0, 0, size[0], size[1], gl.RGBA, gl.UNSIGNED_BYTE, found);
          let text = "";
          for (let y = size[1] - 1; y >= 0; --y)
            text += String.fromCharCode(...found.subarray(4 * size[0] * y, 4 * size[0] * (y + 1)));
          pictures[frame] = btoa(text);
        }
        return { pictures, error: gl.getError() };
      } catch (error) {
        return { reason: (error && (error.message || String(error))) || "failed" };
      } finally {
        Date.now = clock;
        console.log = log;
        gl.getExtension("WEBGL_lose_context")?.loseContext();
      }
    },
    [job, [width, height], fps, frames, picture, fixes],
  );
await browser.close();
writeFileSync(outFile, JSON.stringify(results));
