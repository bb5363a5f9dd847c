#undef main
void ISF_MAIN() {
    isf_vertShaderInit();
    isf_main();
}
