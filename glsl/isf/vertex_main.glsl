void main() {
    isf_vertShaderInit();
    isf_main();
}
