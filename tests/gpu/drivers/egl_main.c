// A driver as libglvnd takes it.
#ifdef USES_PART
int part(void);
#else
static int part(void) { return 1; }
#endif
int __egl_Main(void);
int __egl_Main(void) { return part(); }
