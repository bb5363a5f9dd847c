// A comparison for machines (JSON, CSV) and for people.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "framework/compare/compare_files.h"

namespace aftershade {

/// {"aftershade": 1, "reference", "test", "verdict", "exit_code", "faults", "rules", "layers": [...]}.
/// Numbers that JSON has not are the strings "inf", "-inf" and "nan"; what was not measured is null. Places
/// and boxes are pixels of the files (data windows' coordinates). docs/compare.md lists every key.
nlohmann::ordered_json json_of(const Comparison& comparison, const CompareRules& rules);

/// Indented, with a line end.
std::string json_text(const Comparison& comparison, const CompareRules& rules);

/// A line of names and one for each layer, as RFC 4180 has it: one file for many comparisons wants the line
/// of names once.
std::string csv_header();
std::string csv_rows(const Comparison& comparison);

/// Everything that the verdict ignores: "forgives a shift of up to 1 px; 2.5 % of the pixels left out; not
/// judged: A, Z"; "" if it ignores nothing.
std::string allowances_of(const Comparison& comparison, const CompareRules& rules);

/// For people: one paragraph a layer, the verdict with its allowances at the end.
std::string text_of(const Comparison& comparison, const CompareRules& rules);

}  // namespace aftershade
