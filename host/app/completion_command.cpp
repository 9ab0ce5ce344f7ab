// gnomon completion: what shells and manuals need to know of the program, from its own description of itself.
// Not shown in --help: the build calls it.
#include <CLI/CLI.hpp>
#include <memory>

#include "commands.h"
#include "exit_status.h"

namespace gnomon::app {
namespace {

const char* const kHead =
    "# bash completion for gnomon; made by `gnomon completion bash`\n"
    "_gnomon() {\n"
    "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} path= words= i\n"
    "  COMPREPLY=()\n"
    "  for ((i = 1; i < COMP_CWORD; i++)); do\n"
    "    case \"$path/${COMP_WORDS[i]}\" in\n";
const char* const kTail =
    "  esac\n"
    "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$cur\")\n"
    "}\n"
    "complete -o default -F _gnomon gnomon\n";

bool is_shown(const CLI::App* app) {
  return !app->get_name().empty() && !app->get_group().empty();
}

// What an option's help lists in braces, with blanks between; empty: any text, or a file.
std::string choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t from = type.find('{');
  const std::size_t to = type.find('}', from);
  if (from == std::string::npos || to == std::string::npos) return {};
  std::string words = type.substr(from + 1, to - from - 1);
  for (char& c : words)
    if (c == ',') c = ' ';
  return words;
}

// The app and everything below it: what may come next, by what has come before.
class Script {
 public:
  void add(const CLI::App& app, const std::string& path) {
    std::string words;
    for (const CLI::App* sub : app.get_subcommands(is_shown)) words += sub->get_name() + " ";
    for (const CLI::Option* option : app.get_options()) {
      std::string patterns;
      for (const std::string& name : option->get_lnames()) {
        words += "--" + name + " ";
        patterns += (patterns.empty() ? "\"" : "|\"") + path + " --" + name + "\"";
      }
      for (const std::string& name : option->get_snames())
        patterns += (patterns.empty() ? "\"" : "|\"") + path + " -" + name + "\"";
      const bool takes_value = option->get_items_expected_max() > 0;
      if (takes_value && !patterns.empty())
        values_ += "    " + patterns + ") words=\"" + choices_of(*option) + "\" ;;\n";
    }
    words_ += "    \"" + path + " \"*) words=\"" + words + "\" ;;\n";
    for (const CLI::App* sub : app.get_subcommands(is_shown)) {
      const std::string below = path + "/" + sub->get_name();
      paths_ += (paths_.empty() ? "" : " | ") + below;
      add(*sub, below);
    }
  }

  // Values are looked for first: what follows an option that takes one is not an option.
  [[nodiscard]] std::string text() const {
    return kHead + ("      " + paths_ + ") path+=/${COMP_WORDS[i]} ;;\n") +
           "    esac\n  done\n  case \"$path $prev\" in\n" + values_ + words_ + kTail;
  }

 private:
  std::string paths_, values_, words_;
};

// A line for each subcommand: its words, a tab, what it does.
std::string list_of(const CLI::App& app, const std::string& before) {
  std::string text;
  for (const CLI::App* sub : app.get_subcommands(is_shown)) {
    const std::string words = before + sub->get_name();
    text += words + "\t" + sub->get_description() + "\n" + list_of(*sub, words + " ");
  }
  return text;
}

}  // namespace

void add_completion_command(CLI::App& program, Action& action) {
  const auto what = std::make_shared<std::string>("bash");
  CLI::App* const command =
      program.add_subcommand("completion", "Print a completion script, or all subcommands.");
  command->group("");
  command->add_option("what", *what, "bash or commands")->check(CLI::IsMember({"bash", "commands"}));
  command->callback([&program, &action, what] {
    action = [&program, what](Console& console) {
      Script script;
      script.add(program, "");
      console.print(*what == "bash" ? script.text() : list_of(program, ""));
      return static_cast<int>(kOk);
    };
  });
}

}  // namespace gnomon::app
