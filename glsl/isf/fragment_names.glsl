#include <isf/names.glsl>
#define varying in
#define gl_FragCoord isf_coord()
#define isf_FragNormCoord isf_norm_coord()
#define vv_FragNormCoord isf_norm_coord()
#define IMG_THIS_PIXEL(image) isf_sample_here(image)
#define IMG_THIS_NORM_PIXEL(image) isf_sample_here(image)
#define gl_FragData isf_data
#define gl_FragColor isf_data[0]
#define dFdy(value) (-dFdy(value))
#define dFdyFine(value) (-dFdyFine(value))
#define dFdyCoarse(value) (-dFdyCoarse(value))
