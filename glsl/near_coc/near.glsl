// The filter of Hammon 2007, Practical Post-Process Depth of Field (GPU Gems 3, chapter 28).
const int kDown = 4;  // px a side that one texel of coc_near stands for

// CoC radius in front of the focus plane, px; 0 elsewhere.
float near_radius(float coc) { return max(-coc, 0.0); }
