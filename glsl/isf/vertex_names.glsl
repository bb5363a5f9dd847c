#include <isf/names.glsl>
#define varying out
#define IMG_THIS_PIXEL(image) isf_sample(image, isf_FragNormCoord)
#define IMG_THIS_NORM_PIXEL(image) isf_sample(image, isf_FragNormCoord)
#define isf_FragNormCoord isf_norm
#define vv_FragNormCoord isf_norm
#define vv_vertShaderInit isf_vertShaderInit
