// What `gnomon stability` says of verdicts and long runs, for machines and for people. Feeds the subcommand.
#pragma once

#include "console.h"
#include "gnomon/stability/catalogue.h"
#include "gnomon/stability/soak.h"
#include "table.h"

namespace gnomon::app {

[[nodiscard]] Json to_json(const stability::CaseInfo& info);
[[nodiscard]] Json to_json(const stability::Verdict& verdict);
[[nodiscard]] Json to_json(const stability::SoakPart& part, bool exact);

[[nodiscard]] std::string case_list(const std::vector<stability::CaseInfo>& cases);
// One line a verdict; what is wrong is explained below the table.
[[nodiscard]] std::string verdict_table(const std::vector<stability::Verdict>& verdicts,
                                        const Console& console);
[[nodiscard]] std::string soak_table(const stability::SoakReport& report, bool exact);

}  // namespace gnomon::app
