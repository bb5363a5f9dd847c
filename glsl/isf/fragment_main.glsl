void main() {
    isf_main();
    ISF_OUT = ISF_RESULT(ISF_COLOR);
}
