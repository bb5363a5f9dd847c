#include "framework/base/diagnostics.h"

#include "tests/documents.h"

namespace aftershade {
namespace {

using test::Lines;

TEST(Diagnostics, PrintsLikeACompiler) {
    Diagnostics diagnostics;
    diagnostics.error({"looks/mine.json", 5, 31}, "bokeh.f_number: 0.02 is below the minimum 0.05");
    diagnostics.warning({"capture.json", 2, 1}, "no camera");
    diagnostics.error(option_place(Option::set, "bokeh.taps=x"), "'x' is not a number");
    EXPECT_EQ(
        test::lines_of(diagnostics),
        (Lines{"looks/mine.json:5:31: error: bokeh.f_number: 0.02 is below the minimum 0.05",
               "capture.json:2:1: warning: no camera", "set bokeh.taps=x: error: 'x' is not a number"}));
    EXPECT_EQ(diagnostics.error_count(), 2);
}

TEST(Diagnostics, ShowTheBeginningOfAPlaceLongerThanAnyPath) {
    Diagnostics diagnostics;
    diagnostics.error({"--frames " + std::string(99'991, '1')}, "too long");
    EXPECT_EQ(test::lines_of(diagnostics),
              Lines{"--frames " + std::string(111, '1') + "... (100000 bytes): error: too long"});
}

TEST(Diagnostics, AreNoErrorsWhereThereAreOnlyWarnings) {
    Diagnostics diagnostics;
    diagnostics.warning({"a"}, "b");
    EXPECT_FALSE(diagnostics.has_errors());
    EXPECT_EQ(diagnostics.all().size(), 1U);
}

struct Guess {
    std::string word;
    std::string meant;  ///< "" for no guess
};

TEST(DidYouMean, NamesTheClosestCandidate) {
    const std::vector<std::string> known = {"focus_distance", "focal_length", "f_number",
                                            "shape",          "taps",         "rotation"};
    const std::vector<Guess> guesses = {
        {"focus_dist", "focus_distance"},     // begins it
        {"focus_distanc", "focus_distance"},  // one letter lost
        {"focal_lenght", "focal_length"},     // two swapped
        {"fnumber", "f_number"},              // one lost
        {"f_numbers", "f_number"},            // one too many
        {"sahpe", "shape"},
        {"rotatoin", "rotation"},
        {"tops", "taps"},
        {"zzzzzzzz", ""},
        {"", ""},
        {"q", ""},
    };
    for (const Guess& guess : guesses) {
        const std::string expected = guess.meant.empty() ? "" : "; did you mean '" + guess.meant + "'?";
        EXPECT_EQ(did_you_mean(guess.word, known), expected) << guess.word;
    }
    EXPECT_EQ(did_you_mean("shape", {}), "");
}

TEST(DidYouMean, DoesNotOfferAWordOfWhichNothingIsKept) {
    const std::vector<std::string> known = {"xy", "up"};
    EXPECT_EQ(did_you_mean("ab", known), "");
}

TEST(ListOfNames, ReadsAsASentence) {
    EXPECT_EQ(list_of_names(std::vector<std::string>{}), "");
    EXPECT_EQ(list_of_names(std::vector<std::string>{"a"}), "'a'");
    EXPECT_EQ(list_of_names(std::vector<std::string>{"a", "b"}), "'a' or 'b'");
    EXPECT_EQ(list_of_names(std::vector<std::string>{"a", "b", "c"}, "and"), "'a', 'b' and 'c'");
}

}  // namespace
}  // namespace aftershade
