// Colours for data, for GLSL and C++ alike: both include this file, so it has nothing but these definitions.

// matplotlib's viridis at ninths (Smith and van der Walt 2015, CC0), 0xrrggbb.
#define FALSE_COLOR_RAMP 0x440154, 0x482878, 0x3e4989, 0x31688e, 0x26828e, 0x1f9e89, 0x35b779, 0x6ece58, 0xb5de2b, 0xfde725
// ColorBrewer's RdBu of nine classes from blue to red (Brewer 2002, Apache 2.0), 0xrrggbb.
#define FALSE_COLOR_DIVERGING 0x2166ac, 0x4393c3, 0x92c5de, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xf4a582, 0xd6604d, 0xb2182b

// Values that should not be, in colours that no scale has; and depth where nothing was hit.
#define FALSE_COLOR_NEGATIVE 0.0f, 1.0f, 1.0f
#define FALSE_COLOR_INFINITE 1.0f, 0.35f, 0.0f
#define FALSE_COLOR_NAN 1.0f, 0.0f, 1.0f
#define FALSE_COLOR_NOTHING_HIT 0.45f, 0.45f, 0.45f
