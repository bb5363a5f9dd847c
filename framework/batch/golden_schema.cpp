#include "framework/batch/golden_suite.h"
#include "framework/core/schema_pieces.h"
#include "framework/image/frame_range.h"
#include "framework/pipeline/schema_role.h"

namespace aftershade {

using schema::json;

namespace {

json number(double max = -1) {
    json result = {{"type", "number"}, {"minimum", 0}};
    if (max >= 0) result["maximum"] = max;
    return result;
}

json tolerance() {
    json keys = json::object();
    for (const std::string word : {"fail", "warn"}) {
        keys[word] = number();
        keys[word]["description"] = "A pixel of whose channels one differs by more counts.";
        keys[word + "_percent"] = number(100);
        keys["hard_" + word] = number();
        keys["allow_" + word + (word == "fail" ? "ures" : "ings")] = {{"type", "integer"}, {"minimum", 0}};
        keys[word + "_flip"] = keys[word + "_ssim"] = number(1);
    }
    keys["nan_equal"] = {{"type", "boolean"}};
    return schema::object(keys);
}

json golden_case() {
    json keys = {
        {"name", {{"type", "string"}, {"pattern", "^[A-Za-z0-9_][A-Za-z0-9_-]*$"}}},
        {"look", schema::text()},
        {"steps", {{"type", "array"}, {"description", "Steps as a look has them, instead of 'look'."}}},
        {"capture", schema::text()},
        {"frames", {{"type", "string"}, {"pattern", frame_range_pattern()}}},
        {"set", schema::array_of(schema::text())},
        {"taps", schema::array_of({{"type", "string"}, {"pattern", "^[^./=]*\\.[^./=]*$"}})},
        {"outputs", schema::array_of(schema::role())},
        {"tolerance", tolerance()},
        {"tags", schema::array_of(schema::text())},
        {"skip", {{"type", "string"}, {"minLength", 1}, {"description", "Why the case is not run."}}}};
    json result = schema::object(keys, {"name", "capture"});
    result["oneOf"] = {{{"required", {"look"}}}, {{"required", {"steps"}}}};
    return result;
}

}  // namespace

std::string golden_schema() {
    return schema::document("Aftershade golden suite",
                            {{"goldens", schema::text()},
                             {"effect_paths", schema::array_of(schema::text())},
                             {"cases", schema::array_of(golden_case())},
                             {"cases_of_effects", {{"type", "boolean"}}}},
                            {})
               .dump(2) +
           "\n";
}

}  // namespace aftershade
