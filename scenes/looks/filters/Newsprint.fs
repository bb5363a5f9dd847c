/*{
    "DESCRIPTION": "Prints the picture in dots of four inks.",
    "CREDIT": "The authors of Aftershade",
    "ISFVSN": "2",
    "CATEGORIES": ["Halftone"],
    "INPUTS": [
        { "NAME": "inputImage", "TYPE": "image" },
        { "NAME": "dotSize", "LABEL": "Dot size, px", "TYPE": "float", "MIN": 2.0, "MAX": 40.0, "DEFAULT": 6.0 },
        { "NAME": "paper", "LABEL": "Paper", "TYPE": "color", "DEFAULT": [0.97, 0.95, 0.9, 1.0] }
    ]
}*/

// The coverage of a dot at this pixel, on a screen turned by the angle.
float dot_at(float angle, float ink) {
    vec2 turned = mat2(cos(angle), sin(angle), -sin(angle), cos(angle)) * gl_FragCoord.xy / dotSize;
    float away = length(fract(turned) - 0.5) * dotSize;
    float radius = sqrt(ink / 3.14159265) * dotSize * 1.1;
    return clamp(radius - away + 0.5, 0.0, 1.0);
}

void main() {
    vec4 color = IMG_THIS_PIXEL(inputImage);
    vec3 inks = 1.0 - color.rgb;
    float black = min(inks.r, min(inks.g, inks.b)) * 0.8;
    inks -= black;
    vec3 print = paper.rgb;
    print *= 1.0 - vec3(1.0, 0.25, 0.05) * dot_at(0.262, inks.r);
    print *= 1.0 - vec3(0.05, 1.0, 0.35) * dot_at(1.309, inks.g);
    print *= 1.0 - vec3(0.0, 0.05, 0.95) * dot_at(0.0, inks.b);
    print *= 1.0 - 0.92 * dot_at(0.785, black);
    gl_FragColor = vec4(print, color.a);
}
