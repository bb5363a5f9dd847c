#include <isf/names.glsl>
#define varying out
#define isf_FragNormCoord isf_norm
#define vv_FragNormCoord isf_norm
#define vv_vertShaderInit isf_vertShaderInit
