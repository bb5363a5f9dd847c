// ISF files with one fault each, and where a reader must look for it.
#pragma once

#include <string>
#include <vector>

namespace aftershade::test {

struct BrokenIsf {
    std::string name;
    std::string text;
    int line = 1;
    std::string message;  ///< is in it
};

/// A file whose JSON has these members from line 2 on; the shader draws red.
inline std::string isf_file(
    const std::string& members,
    const std::string& shader = "void main() { gl_FragColor = vec4(1.0, 0.0, 0.0, 1.0); }\n") {
    return "/*{\n" + members + "\n}*/\n" + shader;
}
inline std::string isf_input(const std::string& members) {
    return isf_file("\"INPUTS\": [\n{" + members + "}]");
}
inline std::string isf_passes(const std::string& entries) {
    return isf_file(
        "\"INPUTS\": [{\"NAME\": \"gain\", \"TYPE\": \"float\", \"DEFAULT\": 2}],\n\"PASSES\": [\n" +
        entries + "]");
}

inline std::vector<BrokenIsf> broken_isf_files() {
    const std::string draw = "void main() { gl_FragColor = vec4(1.0); }\n";
    std::string deep, brackets;
    for (int i = 0; i < 100; ++i) deep += "[", brackets += "(";
    std::string many_passes, many_inputs;
    for (int i = 0; i < 70; ++i)
        many_passes += std::string(i > 0 ? "," : "") + "{\"TARGET\": \"b" + std::to_string(i) + "\"}";
    for (int i = 0; i < 300; ++i)
        many_inputs +=
            std::string(i > 0 ? "," : "") + "{\"NAME\": \"b" + std::to_string(i) + "\", \"TYPE\": \"float\"}";
    return {
        {"no JSON", draw, 1, "has none"},
        {"an empty file", "", 1, "has none"},
        {"a comment that is no JSON", "/* by me */\n" + draw, 1, "has none"},
        {"a comment without its end", "\n/*{ \"INPUTS\": []\n" + draw, 2, "not closed"},
        {"a comma too few", isf_file("\"CREDIT\": \"me\"\n\"INPUTS\": []"), 3, "syntax error"},
        {"two commas", isf_file("\"CREDIT\": \"me\",\n\"INPUTS\": [],,"), 4, "syntax error"},
        {"a text without its end", isf_file("\"CREDIT\": \"me"), 2, "syntax error"},
        {"lists too deep", isf_file("\"X\": " + deep), 2, "deep"},
        {"no main", isf_file("\"INPUTS\": []", "float x;\n"), 3, "no main()"},
        {"inputs that are no list", isf_file("\"INPUTS\": {}"), 2, "a list of objects is needed"},
        {"an input that is no object", isf_file("\"INPUTS\": [\n3]"), 3, "an object is needed"},
        {"an input without a name", isf_input("\"TYPE\": \"float\""), 3, "needs a NAME"},
        {"an input without a type", isf_input("\"NAME\": \"a\""), 3, "needs a NAME"},
        {"an unknown type", isf_input("\"NAME\": \"a\", \"TYPE\": \"flaot\""), 3, "did you mean 'float'"},
        {"a type that is a number", isf_input("\"NAME\": \"a\", \"TYPE\": 3"), 3, "a text is needed"},
        {"a name that GLSL does not take", isf_input("\"NAME\": \"2 fast\", \"TYPE\": \"float\""), 3,
         "not a name of GLSL"},
        {"a name of GLSL's own", isf_input("\"NAME\": \"gl_x\", \"TYPE\": \"float\""), 3,
         "not a name of GLSL"},
        {"a name of ISF's own", isf_input("\"NAME\": \"PASSINDEX\", \"TYPE\": \"float\""), 3,
         "a name of ISF itself"},
        {"a main that is a macro",
         isf_file("\"INPUTS\": []", "#define main draw\nvoid main() { gl_FragColor = vec4(1.0); }\n"), 4,
         "main is a macro here"},
        {"a main in a comment alone", isf_file("\"INPUTS\": []", "// void main()\nfloat main_part;\n"), 3,
         "no main()"},
        {"a main that takes something",
         isf_file("\"INPUTS\": []", "\nvoid main(float x) { gl_FragColor = vec4(x); }\n"), 5, "void main()"},
        {"a main that returns something", isf_file("\"INPUTS\": []", "int main() { return 0; }\n"), 4,
         "void main()"},
        {"an in without a vertex shader",
         isf_file("\"INPUTS\": []", "in vec2 at;\nvoid main() { gl_FragColor = vec4(at, 0, 1); }\n"), 4,
         "no vertex shader 'x.vs'"},
        {"a name that is a word of GLSL", isf_input("\"NAME\": \"float\", \"TYPE\": \"float\""), 3,
         "a word of GLSL itself"},
        {"a number of more than 32 bits",
         isf_input("\"NAME\": \"a\", \"TYPE\": \"long\", \"DEFAULT\": 99999999999"), 3,
         "does not fit 32 bits"},
        {"a NUL byte", isf_file("\"CREDIT\": \"me\"", "\n" + draw + std::string(1, '\0')), 6, "a NUL byte"},
        {"a varying that later versions of GLSL have as a word",
         isf_file("\"INPUTS\": []",
                  "varying vec2 sample;\nvoid main() { gl_FragColor = vec4(sample, 0, 1); }\n"),
         4, "no vertex shader 'x.vs'"},
        {"a picture that is not there", isf_file("\"IMPORTED\": {\"x\": {\n\"PATH\": \"a.png\"}}"), 3,
         "not beside the file"},
        {"two inputs of one name",
         isf_file(
             "\"INPUTS\": [{\"NAME\": \"a\", \"TYPE\": \"float\"},\n{\"NAME\": \"a\", \"TYPE\": \"bool\"}]"),
         3, "has already"},
        {"a default that is a text", isf_input("\"NAME\": \"a\", \"TYPE\": \"float\", \"DEFAULT\": \"big\""),
         3, "a number is needed"},
        {"a colour of two numbers", isf_input("\"NAME\": \"a\", \"TYPE\": \"color\", \"DEFAULT\": [1, 2]"), 3,
         "a list of 4 numbers"},
        {"a point of texts", isf_input("\"NAME\": \"a\", \"TYPE\": \"point2D\", \"DEFAULT\": [\"x\", \"y\"]"),
         3, "a list of 2 numbers"},
        {"a bool that is neither", isf_input("\"NAME\": \"a\", \"TYPE\": \"bool\", \"DEFAULT\": \"maybe\""),
         3, "neither true nor false"},
        {"values that are no list", isf_input("\"NAME\": \"a\", \"TYPE\": \"long\", \"VALUES\": 3"), 3,
         "are lists"},
        {"a value that is not whole", isf_input("\"NAME\": \"a\", \"TYPE\": \"long\", \"VALUES\": [0, 1.5]"),
         3, "which 1.5 is not"},
        {"values that are texts", isf_input("\"NAME\": \"a\", \"TYPE\": \"long\", \"VALUES\": [\"x\"]"), 3,
         "whole numbers"},
        {"too many inputs", isf_file("\"INPUTS\": [" + many_inputs + "]"), 2, "the limit is 256"},
        {"passes that are no list", isf_file("\"PASSES\": 3"), 2, "a list of objects is needed"},
        {"too many passes", isf_file("\"PASSES\": [" + many_passes + "]"), 2, "the limit is 64"},
        {"a target that is a number", isf_passes("{\"TARGET\": 3}"), 4, "a text is needed"},
        {"a target with an input's name", isf_passes("{\"TARGET\": \"gain\"}"), 4, "an input has already"},
        {"a pass that keeps nothing", isf_passes("{\"PERSISTENT\": true}, {}"), 4, "has no TARGET"},
        {"a persistent buffer of no pass", isf_file("\"PERSISTENT_BUFFERS\": [\n\"last\"]"), 3,
         "the TARGET of no pass"},
        {"one target of two sizes",
         isf_passes("{\"TARGET\": \"a\", \"WIDTH\": \"8\"},\n{\"TARGET\": \"a\", \"WIDTH\": 9}"), 5,
         "different sizes"},
        {"a formula of an unknown name", isf_passes("{\"TARGET\": \"a\", \"WIDTH\": \"$WIDHT / 2\"}"), 4,
         "'$WIDHT' is not a number"},
        {"a formula of a target that two passes draw",
         isf_passes("{\"TARGET\": \"a\", \"WIDTH\": \"$WIDHT / 2\"},\n{\"TARGET\": \"a\"}"), 4,
         "'$WIDHT' is not a number"},
        {"a formula of an unknown function", isf_passes("{\"TARGET\": \"a\", \"WIDTH\": \"flor($WIDTH)\"}"),
         4, "'flor' is not a function"},
        {"a formula that ends early", isf_passes("{\"TARGET\": \"a\", \"HEIGHT\": \"floor($HEIGHT / \"}"), 4,
         "ends where"},
        {"a formula without end", isf_passes("{\"TARGET\": \"a\", \"HEIGHT\": \"" + brackets + "\"}"), 4,
         "the limit"},
        {"a formula that is a list", isf_passes("{\"TARGET\": \"a\", \"WIDTH\": [1]}"), 4,
         "a number or a formula"},
        {"a huge size", isf_passes("{\"TARGET\": \"a\", \"WIDTH\": \"$WIDTH * 1000\"}"), 4,
         "the limit is 16384"},
        {"a division by nothing", isf_passes("{\"TARGET\": \"a\", \"WIDTH\": \"0 / 0\"}"), 4,
         "the limit is 16384"},
        {"a varying without a vertex shader",
         isf_file("\"INPUTS\": []", "varying vec2 at;\nvoid main() { gl_FragColor = vec4(at, 0, 1); }\n"), 4,
         "no vertex shader 'x.vs'"},
        {"an import without a path", isf_file("\"IMPORTED\": {\n\"x\": {}}"), 3, "has no PATH"},
        {"a cube map of one face", isf_file("\"IMPORTED\": {\"x\": {\n\"PATH\": [\"a.png\"]}}"), 3,
         "a cube map has 6 paths"},
        {"a picture from elsewhere", isf_file("\"IMPORTED\": {\"x\": {\n\"PATH\": \"../a.png\"}}"), 3,
         "must lie in the effect's folder"},
    };
}

}  // namespace aftershade::test
