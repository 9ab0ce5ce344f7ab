#include "row_schema.h"

#include <algorithm>

#include "gnomon/base/error.h"

namespace gnomon::app {

extern const char* const kRowSchemaText;

namespace {

FieldRole role_of(const std::string& name) {
  if (name == "identity") return FieldRole::kIdentity;
  if (name == "source") return FieldRole::kSource;
  if (name == "exact") return FieldRole::kExact;
  if (name == "spread") return FieldRole::kSpread;
  if (name == "single") return FieldRole::kSingle;
  if (name == "detail") return FieldRole::kDetail;
  throw Error(ErrorCode::kInvalidArgument, "schema of rows: no such role: " + name);
}

RowField field_of(const std::string& name, const RowJson& json) {
  RowField field;
  field.name = name;
  field.role = role_of(json.at("role"));
  field.type = json.at("type");
  field.unit = json.value("unit", "");
  field.better = json.value("better", "");
  field.optional = json.value("optional", false);
  field.null = json.value("null", false);
  field.means = json.at("means");
  return field;
}

RowKind kind_from(const RowJson& json, const RowJson& shared) {
  RowKind kind;
  kind.title = json.at("title");
  kind.bench = json.at("bench");
  kind.schema = json.at("schema");
  for (const auto& [field, values] : json.at("when").items())
    kind.when.emplace_back(field, values.get<std::vector<std::string>>());
  kind.written_by = json.at("written_by");
  kind.files = json.at("files").get<std::vector<std::string>>();
  for (const std::string name : json.at("shared")) kind.fields.push_back(field_of(name, shared.at(name)));
  for (const auto& [name, field] : json.at("fields").items()) kind.fields.push_back(field_of(name, field));
  return kind;
}

bool has_numbers(const RowJson& value, std::initializer_list<const char*> names) {
  return value.is_object() && value.size() == names.size() &&
         std::all_of(names.begin(), names.end(),
                     [&](const char* name) { return value.contains(name) && value.at(name).is_number(); });
}

bool is_of_type(const RowJson& value, const std::string& type) {
  if (type == "text") return value.is_string();
  if (type == "flag") return value.is_boolean();
  if (type == "count") return value.is_number_unsigned();
  if (type == "number") return value.is_number();
  if (type == "spread")
    return has_numbers(value, {"median", "min", "max", "n"}) && value.at("min") <= value.at("median") &&
           value.at("median") <= value.at("max");
  if (type == "mean") return has_numbers(value, {"mean", "standard_error"});
  if (type == "object") return value.is_object();
  return type == "list" && value.is_array();
}

}  // namespace

bool RowKind::matches(const RowJson& row) const {
  if (row.value("bench", "") != bench || row.value("schema", std::uint64_t{0}) != schema) return false;
  return std::all_of(when.begin(), when.end(), [&](const auto& condition) {
    const std::string value = row.value(condition.first, "");
    return std::find(condition.second.begin(), condition.second.end(), value) != condition.second.end();
  });
}

const RowField* RowKind::find(std::string_view name) const {
  const auto found =
      std::find_if(fields.begin(), fields.end(), [&](const RowField& field) { return field.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

RowSchema::RowSchema(std::string_view text) {
  try {
    const RowJson json = RowJson::parse(text);
    for (const RowJson& kind : json.at("rows")) kinds_.push_back(kind_from(kind, json.at("shared")));
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorCode::kInvalidArgument, std::string("schema of rows: ") + error.what());
  }
}

const RowSchema& RowSchema::built_in() {
  static const RowSchema schema(kRowSchemaText);
  return schema;
}

const RowKind* RowSchema::kind_of(const RowJson& row) const {
  const auto found =
      std::find_if(kinds_.begin(), kinds_.end(), [&](const RowKind& kind) { return kind.matches(row); });
  return found == kinds_.end() ? nullptr : &*found;
}

std::optional<std::string> RowSchema::fault_of(const RowJson& row) const {
  const RowKind* const kind = kind_of(row);
  if (kind == nullptr)
    return "no kind of row has bench " + row.value("bench", "(none)") + ", schema " +
           std::to_string(row.value("schema", std::uint64_t{0}));
  for (const RowField& field : kind->fields) {
    if (!row.contains(field.name)) {
      if (field.optional) continue;
      return "field " + field.name + " is missing";
    }
    const RowJson& value = row.at(field.name);
    if (value.is_null() && field.null) continue;
    if (!is_of_type(value, field.type))
      return "field " + field.name + " is not a " + field.type + ": " + value.dump();
  }
  for (const auto& [name, value] : row.items())
    if (kind->find(name) == nullptr) return "field " + name + " is unknown";
  return std::nullopt;
}

}  // namespace gnomon::app
