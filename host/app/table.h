// Short aligned tables for people. Not for machines: those read --json. Feeds the subcommands.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon::app {

// Columns as wide as their widest cell, two blanks apart. The first column is flush left, the others right.
class Table {
 public:
  explicit Table(std::vector<std::string> heads) : heads_(std::move(heads)) {}
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  [[nodiscard]] std::string text() const;

 private:
  std::vector<std::string> heads_;
  std::vector<std::vector<std::string>> rows_;
};

// Names and values, one pair a line, values flush left.
class Facts {
 public:
  void add(std::string name, std::string value) { pairs_.emplace_back(std::move(name), std::move(value)); }
  [[nodiscard]] std::string text() const;

 private:
  std::vector<std::pair<std::string, std::string>> pairs_;
};

}  // namespace gnomon::app
