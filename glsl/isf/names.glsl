// GLSL 1.20 and ISF's own names, for the file behind them.
#define PASSINDEX ISF_PASS
#define IMG_PIXEL(image, at) isf_sample_pixel(image, at)
#define IMG_NORM_PIXEL(image, at) isf_sample(image, at)
#define IMG_SIZE(image) isf_size(image)
#define VVSAMPLER_2DBYPIXEL(image, rect, size, flip, at) isf_sample_pixel(image, at)
#define VVSAMPLER_2DBYNORM(image, rect, size, flip, at) isf_sample(image, at)
#define sampler2DRect sampler2D
#define texture isf_sample
#define texture2D isf_sample
#define textureCube isf_sample
#define textureCubeLod isf_sample_level
#define textureCubeLodEXT isf_sample_level
#define texture2DRect isf_sample_pixel
#define texture2DLod isf_sample_level
#define texture2DLodEXT isf_sample_level
#define textureLod isf_sample_level
#define texture2DProj isf_sample_part
#define textureProj isf_sample_part
#define texture2DProjLod isf_sample_part_level
#define texture2DRectProj(image, at) isf_sample_pixel(image, (at).xy / (at).z)
#define texture2DGrad isf_sample_slope
#define texture2DGradARB isf_sample_slope
#define textureProjLod isf_sample_part_level
#define textureProjGrad isf_sample_part_slope
#define textureGrad isf_sample_slope
#define textureOffset isf_sample_beside
#define textureLodOffset isf_sample_level_beside
#define texelFetchOffset isf_fetch_beside
#define textureGather isf_gather
