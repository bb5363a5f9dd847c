// docs/reliability.md lists faults and the tests that show what happens: each of them is there.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

/// "Suite.Name" of every test, and "Suite.Row" of the tables of faults in its file.
std::set<std::string> tests_of(const std::string& source) {
    std::set<std::string> tests, table_suites, rows;
    for (const std::string macro : {"TEST(", "TEST_F(", "TEST_P("})
        for (std::size_t at = source.find(macro); at != std::string::npos; at = source.find(macro, at + 1)) {
            const std::size_t begin = at + macro.size(), comma = source.find(", ", begin);
            const std::size_t end = source.find(')', begin);
            if (comma == std::string::npos || comma > end) continue;
            const std::string suite = source.substr(begin, comma - begin);
            tests.insert(suite + "." + source.substr(comma + 2, end - comma - 2));
            if (macro == "TEST_P(" && suite.ends_with("Fault")) table_suites.insert(suite);
        }
    for (std::size_t at = source.find('"'); at != std::string::npos; at = source.find('"', at + 1))
        if (const std::size_t end = source.find('"', at + 1); end != std::string::npos)
            rows.insert(source.substr(at + 1, end - at - 1));
    for (const std::string& suite : table_suites)
        for (const std::string& row : rows) tests.insert(suite + "." + row);
    return tests;
}

std::set<std::string> all_tests() {
    std::set<std::string> tests;
    for (const char* folder : {"tests", "effects"})
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(AFTERSHADE_SOURCE_DIR) / folder))
            if (entry.path().extension() == ".cpp") tests.merge(tests_of(read_text(entry.path())));
    return tests;
}

struct Row {
    std::string fault;
    std::vector<std::string> tests;
    bool has_reason = false;
};

std::vector<Row> rows_of_page() {
    std::ifstream page(AFTERSHADE_SOURCE_DIR "/docs/reliability.md");
    std::vector<Row> rows;
    bool in_faults = false;
    for (std::string line; std::getline(page, line);) {
        if (line.starts_with("## ")) in_faults = line == "## Faults";
        if (!in_faults || !line.starts_with("| ") || line.starts_with("| fault |")) continue;
        Row row;
        std::vector<std::string> cells;
        std::istringstream text(line.substr(1));
        for (std::string cell; std::getline(text, cell, '|');) cells.push_back(cell);
        row.fault = cells.at(0);
        row.has_reason = cells.at(1).find("not tested: ") != std::string::npos;
        std::istringstream names(cells.at(2));
        for (std::string name; names >> name;) row.tests.push_back(name);
        rows.push_back(std::move(row));
    }
    return rows;
}

TEST(FaultTable, NamesATestThatExistsForEachFaultOrSaysWhyThereIsNone) {
    const std::set<std::string> known = all_tests();
    const std::vector<Row> rows = rows_of_page();
    EXPECT_GE(rows.size(), 40u);
    for (const Row& row : rows) {
        EXPECT_EQ(row.tests.empty(), row.has_reason) << row.fault;
        for (const std::string& name : row.tests) {
            ASSERT_TRUE(name.size() > 2 && name.front() == '`' && name.back() == '`') << name;
            EXPECT_TRUE(known.contains(name.substr(1, name.size() - 2))) << row.fault << name;
        }
    }
}

TEST(FaultTable, KnowsTestsFromOtherWords) {
    const auto tests = tests_of("TEST(A, IsB) {}\nTEST_P(CFault, Is) {}\n{\"Row\", 1}");
    EXPECT_EQ(tests, (std::set<std::string>{"A.IsB", "CFault.Is", "CFault.Row"}));
}

}  // namespace
}  // namespace aftershade::test
