#include <nlohmann/json.hpp>

#include "completion/command_parts.hpp"

namespace edsc {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const OptionParts& option) {
  Json json{{"names", option.names},
            {"value", option.value.name},
            {"kind", to_string(option.value.kind)},
            {"description", option.description},
            {"required", option.is_required},
            {"repeats", option.repeats}};
  if (!option.value.words.empty()) json["words"] = option.value.words;
  if (!option.default_text.empty()) json["default"] = option.default_text;
  return json;
}

void append_commands(Json& list, const CommandParts& command) {
  Json json{{"command", command.path_with(" ")},
            {"usage", usage_line(command)},
            {"description", command.description},
            {"arguments", Json::array()},
            {"options", Json::array()}};
  for (const OptionParts& argument : command.arguments) json["arguments"].push_back(json_of(argument));
  for (const OptionParts& option : command.options) json["options"].push_back(json_of(option));
  list.push_back(std::move(json));
  for (const CommandParts& sub : command.subcommands) append_commands(list, sub);
}

}  // namespace

std::string commands_json(const CommandParts& program) {
  Json json{{"schema", 1}, {"commands", Json::array()}, {"vocabulary", Json::array()}, {"old_options", Json::array()}};
  append_commands(json["commands"], program);
  for (const CommandOptionRow& row : command_option_rows()) {
    json["vocabulary"].push_back({{"name", row.name},
                                  {"short", row.short_name == 0 ? "" : std::string{'-', row.short_name}},
                                  {"value", row.value},
                                  {"kind", to_string(row.kind)},
                                  {"meaning", row.meaning}});
  }
  for (const OldOptionRow& row : old_option_rows()) {
    json["old_options"].push_back(
        {{"command", row.command}, {"name", row.name}, {"now", row.now}, {"unit", row.unit}, {"value", row.value}});
  }
  return json.dump(1) + "\n";
}

}  // namespace edsc
