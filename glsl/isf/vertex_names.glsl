#include <isf/names.glsl>
#define varying out
#define IMG_THIS_PIXEL(image) isf_sample(image, isf_FragNormCoord)
#define IMG_THIS_NORM_PIXEL(image) isf_sample(image, isf_FragNormCoord)
#define isf_FragNormCoord isf_norm
#define vv_FragNormCoord isf_norm
#define vv_vertShaderInit isf_vertShaderInit
// The pipeline of GLSL 1.20, whose quad is the picture.
#define gl_Vertex isf_vertex()
#define gl_MultiTexCoord0 vec4(isf_corner, 0.0, 1.0)
#define gl_ModelViewProjectionMatrix mat4(1.0)
#define ftransform() isf_vertex()
