// The part of a page that is about one device. Not public. Feeds page.cpp.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "gnomon/compare/report.h"

namespace gnomon::compare {

class DevicePage {
 public:
  // Both must outlive it.
  DevicePage(const Report& report, const DeviceReport& device) : report_(report), device_(device) {}

  [[nodiscard]] std::string advice() const;
  [[nodiscard]] std::string body() const;
  // The script's lines, by kind.
  [[nodiscard]] nlohmann::ordered_json lines() const;
  [[nodiscard]] std::string facts() const;

 private:
  [[nodiscard]] std::string control() const;
  [[nodiscard]] std::string table() const;
  [[nodiscard]] std::string decisions() const;
  [[nodiscard]] std::string pictures() const;
  [[nodiscard]] std::string left_out() const;

  const Report& report_;
  const DeviceReport& device_;
};

// Pieces of HTML; contents are markup already.
[[nodiscard]] std::string html_element(const std::string& name, const std::string& content);
[[nodiscard]] std::string html_cell(const std::string& content, const std::string& classes = "");
// A name and its value, for a list of facts.
[[nodiscard]] std::string html_fact(const std::string& name, const std::string& value);
// A command or a part of one: lines end between options, not inside one or before its short value.
[[nodiscard]] std::string html_command(const std::string& command);

}  // namespace gnomon::compare
