#undef main
void ISF_MAIN() {
    isf_main();
    ISF_OUT = ISF_RESULT(isf_data[0]);
}
