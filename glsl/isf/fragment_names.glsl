#include <isf/names.glsl>
#define varying in
#define gl_FragCoord isf_FragCoord
#define vv_FragNormCoord isf_FragNormCoord
#define gl_FragData isf_data
#define gl_FragColor isf_data[0]
#define isf_FragColor isf_data[0]
