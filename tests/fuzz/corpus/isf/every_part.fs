/*{
"DESCRIPTION": "Every part of ISF.", "CREDIT": "me", "ISFVSN": "2", "CATEGORIES": ["Test"],
"INPUTS": [{"NAME": "inputImage", "TYPE": "image"}, {"NAME": "mask", "TYPE": "image", "LABEL": "Mask"},
{"NAME": "mode", "TYPE": "long", "VALUES": [2, 5], "LABELS": ["Two", "Five"], "DEFAULT": 5, "IDENTITY": 2},
{"NAME": "amount", "TYPE": "float", "DEFAULT": 0.25, "MIN": 0, "MAX": 1, "IDENTITY": 0},
{"NAME": "tint", "TYPE": "color", "DEFAULT": [0.1, 0.2, 0.3, 1]}, {"NAME": "at", "TYPE": "point2D", "DEFAULT": [0.5, 0.5]},
{"NAME": "on", "TYPE": "bool", "DEFAULT": true}, {"NAME": "go", "TYPE": "event"}, {"NAME": "wave", "TYPE": "audio"},
{"NAME": "fft", "TYPE": "audioFFT"}],
"IMPORTED": {"noise": {"PATH": "noise.png"}}, "PERSISTENT_BUFFERS": ["last"],
"PASSES": [{"TARGET": "small", "WIDTH": "floor($WIDTH / 3.0)", "HEIGHT": "max($HEIGHT * $amount, 2)", "FLOAT": true},
{"TARGET": "last", "PERSISTENT": true, "DESCRIPTION": "Keeps."}, {}]
}*/
#version 120
varying vec2 above;
#define frame 3
void main() {
    vec4 color = PASSINDEX == 0 ? texture2D(inputImage, above) : IMG_THIS_NORM_PIXEL(small);
    if (mode == 5 && !go && on) color += tint;
    gl_FragColor = color * amount + IMG_THIS_PIXEL(mask) + IMG_NORM_PIXEL(wave, at) + IMG_PIXEL(fft, at) + IMG_THIS_PIXEL(last) +
                   IMG_THIS_PIXEL(noise) * TIME;
}
