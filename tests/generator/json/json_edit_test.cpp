// Edits of JSON texts: a table of texts written by hand, and random edits of the files of the repository, for which
// nlohmann::json says what the result must be.
#include "json/json_edit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "json/json_ranges.hpp"

namespace edsc {
namespace {

using Value = nlohmann::ordered_json;

Value parsed(std::string_view text) {
  Value value = Value::parse(text, nullptr, false, true);
  EXPECT_FALSE(value.is_discarded()) << text;
  return value;
}

std::string set(std::string_view text, std::string_view pointer, const char* value) {
  return with_json_value(text, *json_path(pointer), Value::parse(value)).value_or("nothing");
}
std::string removed(std::string_view text, std::string_view pointer) {
  return without_json_value(text, *json_path(pointer)).value_or("nothing");
}
std::string renamed(std::string_view text, std::string_view pointer, std::string_view name) {
  return with_json_name(text, *json_path(pointer), name).value_or("nothing");
}
std::string moved(std::string_view text, std::string_view pointer, std::size_t to) {
  return with_json_moved(text, *json_path(pointer), to).value_or("nothing");
}

TEST(JsonEdit, ReplacesAValue) {
  EXPECT_EQ(set("{ \"a\" : 1 /* x */, // y\n\"b\": [1,\r\n2] }", "/a", "\"2\""),
            "{ \"a\" : \"2\" /* x */, // y\n\"b\": [1,\r\n2] }");
  EXPECT_EQ(set("{\"a\": [1, 2]}", "/a/1", "{}"), "{\"a\": [1, {}]}");
  EXPECT_EQ(set("{\"a\": 1, \"a\": 2}", "/a", "3"), "{\"a\": 1, \"a\": 3}");
  EXPECT_EQ(set("7 // all", "", "[1]"), "[1] // all");
  EXPECT_EQ(set("{\"a\": \"}\\\"\"}", "/a", "\"\xC3\xA4\\\\\""), "{\"a\": \"\xC3\xA4\\\\\"}");
}

TEST(JsonEdit, ReplacesTheElementsThatDiffer) {
  EXPECT_EQ(set("[1, /* two */ 2, 3]", "", "[1, 5, 3]"), "[1, /* two */ 5, 3]");
  EXPECT_EQ(set("[1, 2, /* three */ 3]", "", "[2, 3]"), "[2, /* three */ 3]");
  EXPECT_EQ(set("[\n  1, // one\n  2\n]", "", "[1, 2, 3]"), "[\n  1, // one\n  2,\n  3\n]");
  EXPECT_EQ(set("{\"a\": [1]}", "/a", "[]"), "{\"a\": []}");
  EXPECT_EQ(set("{\"a\": \"x\"}", "/a", "[\"x\", \"y\"]"), "{\"a\": [\"x\", \"y\"]}");
}

TEST(JsonEdit, AddsAMemberLikeTheOthers) {
  EXPECT_EQ(set("{}", "/a", "1"), "{\"a\": 1}");
  EXPECT_EQ(set("{ }", "/a", "1"), "{ \"a\": 1 }");
  EXPECT_EQ(set("{\n}", "/a", "1"), "{\n  \"a\": 1\n}");
  EXPECT_EQ(set("{ // none\n}", "/a", "1"), "{ // none\n  \"a\": 1\n}");
  EXPECT_EQ(set("{ /* none */ }", "/a", "1"), "{ /* none */ \"a\": 1 }");
  EXPECT_EQ(set("{\"a\":1}", "/b", "2"), "{\"a\":1, \"b\":2}");
  EXPECT_EQ(set("{\"a\" :1,\"b\" :2}", "/c", "3"), "{\"a\" :1,\"b\" :2,\"c\" :3}");
  EXPECT_EQ(set("{\r\n\t\"a\": 1 // one\r\n}\n", "/b", "2"), "{\r\n\t\"a\": 1, // one\r\n\t\"b\": 2\r\n}\n");
  EXPECT_EQ(set("{\n  \"a\": 1 }", "/b", "2"), "{\n  \"a\": 1,\n  \"b\": 2 }");
  EXPECT_EQ(set("{ \"a\": 1\n, \"b\": 2\n}", "/c", "3"), "{ \"a\": 1\n, \"b\": 2\n, \"c\": 3\n}");
  EXPECT_EQ(set("{\n  \"a\": {\"x\": 1}, \"b\": {}\n}", "/b/y", "2"), "{\n  \"a\": {\"x\": 1}, \"b\": {\"y\": 2}\n}");
}

TEST(JsonEdit, AddsAValueWithTheStyleOfTheOthers) {
  EXPECT_EQ(set("{\n  \"n\": {\n    \"a\": { \"i\": 1 }\n  }\n}", "/n/b", R"({"i": 2, "to": ["x", "y"]})"),
            "{\n  \"n\": {\n    \"a\": { \"i\": 1 },\n    \"b\": { \"i\": 2, \"to\": [\"x\", \"y\"] }\n  }\n}");
  EXPECT_EQ(
      set("{\n  \"n\": {\n    \"a\": {\n      \"i\":1\n    }\n  }\n}", "/n/b", R"({"i": 2, "k": 3})"),
      "{\n  \"n\": {\n    \"a\": {\n      \"i\":1\n    },\n    \"b\": {\n      \"i\":2,\n      \"k\":3\n    }\n  }\n}");
  EXPECT_EQ(set("{\n    \"s\": []\n}", "/s/-", R"({"i": 2})"), "{\n    \"s\": [\n        {\"i\": 2}\n    ]\n}");
  EXPECT_EQ(set("{\n  \"b\": { \"x\": 1 }\n}", "/n", R"({"a": {"i": 2}})"),
            "{\n  \"b\": { \"x\": 1 },\n  \"n\": {\n    \"a\": { \"i\": 2 }\n  }\n}");
  EXPECT_EQ(set("{\n  \"b\": 5\n}", "/n", R"({"a": {"i": 2}})"),
            "{\n  \"b\": 5,\n  \"n\": {\n    \"a\": {\"i\": 2}\n  }\n}");
  EXPECT_EQ(set("{\n  \"n\": {\n    \"a\": {\"i\": 1}\n  }\n}", "/s", R"({"i": 2})"),
            "{\n  \"n\": {\n    \"a\": {\"i\": 1}\n  },\n  \"s\": {\"i\": 2}\n}");
  EXPECT_EQ(set("{\"n\": {}}\n", "/s", R"([{"i": 2}])"), "{\"n\": {}, \"s\": [{\"i\": 2}]}\n");
  EXPECT_EQ(set("[1,2]", "/-", "3"), "[1,2,3]");
  EXPECT_EQ(set("[\n1,\n2]", "/-", "3"), "[\n1,\n2,\n3]");
}

TEST(JsonEdit, RemovesAMemberWithItsComma) {
  EXPECT_EQ(removed("{\"a\": 1}", "/a"), "{}");
  EXPECT_EQ(removed("{ \"a\": 1 }", "/a"), "{ }");
  EXPECT_EQ(removed("{\"a\": 1, \"b\": 2, \"c\": 3}", "/a"), "{\"b\": 2, \"c\": 3}");
  EXPECT_EQ(removed("{\"a\": 1, \"b\": 2, \"c\": 3}", "/b"), "{\"a\": 1, \"c\": 3}");
  EXPECT_EQ(removed("{\"a\": 1, \"b\": 2, \"c\": 3}", "/c"), "{\"a\": 1, \"b\": 2}");
  EXPECT_EQ(removed("{\"a\": 1, /* b */ \"b\": 2}", "/b"), "{\"a\": 1 /* b */}");
  EXPECT_EQ(removed("{\"a\": 1, /* b */ \"b\": 2}", "/a"), "{/* b */ \"b\": 2}");
  EXPECT_EQ(removed("{\n  \"a\": 1, // one\n  // two\n  \"b\": 2 // and two\n}", "/a"),
            "{\n  // two\n  \"b\": 2 // and two\n}");
  EXPECT_EQ(removed("{\n  \"a\": 1, // one\n  // two\n  \"b\": 2 // and two\n}", "/b"),
            "{\n  \"a\": 1 // one\n  // two\n}");
  EXPECT_EQ(removed("{\n  \"a\": [\n    1\n  ],\n  \"b\": 2\n}", "/a"), "{\n  \"b\": 2\n}");
  EXPECT_EQ(removed("{ \"a\": 1\n, \"b\": 2\n, \"c\": 3\n}", "/b"), "{ \"a\": 1\n, \"c\": 3\n}");
  EXPECT_EQ(removed("{ \"a\": 1\n, \"b\": 2\n, \"c\": 3\n}", "/c"), "{ \"a\": 1\n, \"b\": 2\n}");
  EXPECT_EQ(removed("{ \"a\": 1\n, \"b\": 2\n}", "/a"), "{ \"b\": 2\n}");
  EXPECT_EQ(removed("[\n  1, 2,\n  3]", "/2"), "[\n  1, 2\n]");
}

TEST(JsonEdit, RenamesAMember) {
  EXPECT_EQ(renamed("{\"a\" : 1, \"b\": {\"a\": 2}}", "/b/a", "c\"d"), "{\"a\" : 1, \"b\": {\"c\\\"d\": 2}}");
  EXPECT_EQ(renamed("{\"a/b\": 1}", "/a~1b", "x"), "{\"x\": 1}");
  EXPECT_EQ(renamed("[1]", "/0", "x"), "nothing");
}

TEST(JsonEdit, MovesLinesWithTheirComments) {
  const std::string text = "[\n  // one\n  1, // uno\n  2,\n\n  3 // tres\n  // end\n]";
  EXPECT_EQ(moved(text, "/0", 2), "[\n  2,\n\n  3, // tres\n  // one\n  1 // uno\n  // end\n]");
  EXPECT_EQ(moved(text, "/2", 0), "[\n\n  3, // tres\n  // one\n  1, // uno\n  2\n  // end\n]");
  EXPECT_EQ(moved(text, "/1", 1), text);
  EXPECT_EQ(moved("[1, /* x */ 2,3]", "/0", 1), "[2, /* x */ 1,3]");
  EXPECT_EQ(moved("{\"a\": 1,\n \"b\": 2}", "/b", 0), "{\"b\": 2,\n \"a\": 1}");
  EXPECT_EQ(moved("[1]", "/0", 1), "nothing");
}

TEST(JsonEdit, HasNoResultForAMissingPlace) {
  EXPECT_EQ(set("{\"a\": 1}", "/b/c", "1"), "nothing");
  EXPECT_EQ(set("{\"a\": 1}", "/a/c", "1"), "nothing");
  EXPECT_EQ(set("[1]", "/1", "1"), "nothing");
  EXPECT_EQ(removed("[1]", "/01"), "nothing");
  EXPECT_EQ(removed("[1]", ""), "nothing");
  EXPECT_EQ(json_path("a"), std::nullopt);
  EXPECT_EQ(json_path("/a~2"), std::nullopt);
}

TEST(JsonEdit, OfADeepText) {
  constexpr std::size_t depth = 100'000;
  const std::string text = std::string(depth, '[') + std::string(depth, ']');
  EXPECT_EQ(JsonRanges{text}[JsonRanges::root].end, text.size());
}

TEST(JsonRangesTest, FindThePathOfAPlace) {
  const std::string text = "{\"a/b\": [1, {\"c\": 2}]} // end";
  const JsonRanges ranges{text};
  const auto at = [&](std::string_view place) { return json_pointer(ranges.path_at(text.find(place))); };
  EXPECT_EQ(at("a/b"), "/a~1b");
  EXPECT_EQ(at("1, "), "/a~1b/0");
  EXPECT_EQ(at("\"c\""), "/a~1b/1/c");
  EXPECT_EQ(at("2}"), "/a~1b/1/c");
  EXPECT_EQ(at("// end"), "");
}

// Random edits of the files of the repository.

std::vector<std::string> json_texts() {
  std::vector<std::string> texts;
  for (const char* const folder : {"examples", "tests/networks", "tests/fuzz/network_seeds", "eds"}) {
    for (const auto& file : std::filesystem::recursive_directory_iterator{std::string{EDSC_SOURCE_DIR "/"} + folder}) {
      if (file.path().extension() != ".json" || file.file_size() > 8'000) continue;
      std::ostringstream text;
      text << std::ifstream{file.path(), std::ios::binary}.rdbuf();
      if (!Value::parse(text.str(), nullptr, false, true).is_structured()) continue;
      texts.push_back(text.str());
      std::string windows;
      for (const char c : text.str()) windows += c == '\n' ? std::string{"\r\n"} : std::string{c};
      texts.push_back(std::move(windows));
    }
  }
  return texts;
}

/// A text with blanks, line ends and comments at any place.
class RandomJsonText {
 public:
  explicit RandomJsonText(unsigned seed) : random_{seed} {}

  std::string value(int depth = 0) {
    const std::size_t kind = depth == 0 ? 4 + random(2) : random(depth < 4 ? 6 : 4);
    if (kind == 0) return "-1.5e3";
    if (kind == 1) return R"("a \" // \\")";
    if (kind == 2) return "null";
    if (kind == 3) return R"("]}, /*")";
    std::string text = kind == 4 ? "{" : "[";
    const std::size_t count = random(4);
    for (std::size_t i = 0; i < count; ++i) {
      if (i > 0) text += blank() + ",";
      text += blank();
      if (kind == 4) text += '"' + std::string(1, static_cast<char>('a' + i)) + '"' + blank() + ":" + blank();
      text += value(depth + 1);
    }
    return text + blank() + (kind == 4 ? "}" : "]");
  }

  std::string blank() {
    constexpr const char* blanks[] = {"",       "",       "",        " ",        "\n",        "\r\n  ",
                                      "\t",     "\n  ",   "/* x */", "/* \n */", " // y, \n", "// \"z\"\r\n  ",
                                      "/**/\n", " /*,*/ "};
    return blanks[random(std::size(blanks))];
  }

 private:
  std::size_t random(std::size_t count) { return std::uniform_int_distribution<std::size_t>{0, count - 1}(random_); }

  std::mt19937 random_;
};

class RandomJsonEdits {
 public:
  /// `has_inverse`: an edit and its inverse give the same bytes.
  explicit RandomJsonEdits(std::string text, bool has_inverse = true)
      : text_{std::move(text)}, has_inverse_{has_inverse}, ranges_{text_}, value_{parsed(text_)} {}

  void run() {
    for (int round = 0; round < 3; ++round) {
      add();
      remove();
      rename();
      move();
      replace();
    }
  }

 private:
  std::size_t random(std::size_t count) { return std::uniform_int_distribution<std::size_t>{0, count - 1}(random_); }
  std::size_t any_range() { return random(ranges_.size()); }

  JsonPath path_of(std::size_t index) {
    JsonPath path;
    for (; ranges_[index].parent; index = *ranges_[index].parent) {
      const bool is_element = ranges_[index].name_end == 0;
      path.insert(path.begin(), is_element ? std::to_string(ranges_.place_of(index)) : ranges_[index].name);
    }
    return path;
  }
  static Value::json_pointer pointer_of(const JsonPath& path) { return Value::json_pointer{json_pointer(path)}; }

  Value any_value() {
    constexpr const char* values[] = {"1", "\"a \\\" text\"", "true", "{}", "[1, 2]", R"({"x": 1, "y": [true, "}"]})"};
    return Value::parse(values[random(std::size(values))]);
  }

  void add() {
    const std::size_t owner = any_range();
    if (ranges_[owner].children.empty()) return;
    JsonPath path = path_of(owner);
    const bool is_array = ranges_.is_array(ranges_[owner]);
    path.emplace_back(is_array ? "-" : "new");
    Value expected = value_;
    const Value added = any_value();
    expected[pointer_of(path)] = added;
    const std::string after = *with_json_value(text_, path, added);
    EXPECT_EQ(parsed(after).dump(), expected.dump());
    if (is_array) path.back() = std::to_string(ranges_[owner].children.size());
    if (has_inverse_) EXPECT_EQ(*without_json_value(after, path), text_);
  }

  void remove() {
    const JsonPath path = path_of(any_range());
    if (path.empty()) return;
    Value expected = value_;
    Value& owner = expected[pointer_of({path.begin(), path.end() - 1})];
    if (owner.is_array()) {
      owner.erase(std::stoul(path.back()));
    } else {
      owner.erase(path.back());
    }
    EXPECT_EQ(parsed(*without_json_value(text_, path)).dump(), expected.dump());
  }

  void rename() {
    JsonPath path = path_of(any_range());
    if (path.empty()) return;
    const auto after = with_json_name(text_, path, "a \\ name");
    if (!after) return;
    const std::string before = std::exchange(path.back(), "a \\ name");
    EXPECT_EQ(parsed(*after)[pointer_of(path)], value_[pointer_of({path.begin(), path.end() - 1})][before]);
    if (text_.find('\\') == std::string::npos) EXPECT_EQ(*with_json_name(*after, path, before), text_);
  }

  void move() {
    const std::size_t one = any_range();
    if (one == JsonRanges::root || ranges_[one].name_end != 0) return;
    JsonPath path = path_of(one);
    const std::size_t from = ranges_.place_of(one), to = random(ranges_[*ranges_[one].parent].children.size());
    Value expected = value_;
    Value& owner = expected[pointer_of({path.begin(), path.end() - 1})];
    const Value value = owner[from];
    owner.erase(from);
    owner.insert(owner.begin() + static_cast<std::ptrdiff_t>(to), value);
    const std::string after = *with_json_moved(text_, path, to);
    EXPECT_EQ(parsed(after).dump(), expected.dump());
    path.back() = std::to_string(to);
    const std::string back = *with_json_moved(after, path, from);
    EXPECT_EQ(parsed(back).dump(), value_.dump());
    if (has_inverse_) EXPECT_EQ(back, text_);
  }

  void replace() {
    const std::size_t one = any_range();
    const JsonPath path = path_of(one);
    Value expected = value_;
    const Value value = any_value();
    expected[pointer_of(path)] = value;
    const std::string after = *with_json_value(text_, path, value);
    EXPECT_EQ(parsed(after).dump(), expected.dump());
    if (!ranges_[one].children.empty() || ranges_.value_text(ranges_[one]) != value_[pointer_of(path)].dump()) return;
    EXPECT_EQ(*with_json_value(after, path, value_[pointer_of(path)]), text_);
  }

  std::string text_;
  bool has_inverse_;
  JsonRanges ranges_;
  Value value_;
  std::mt19937 random_{1};
};

TEST(JsonEdit, RandomEditsOfRandomTexts) {
  for (unsigned seed = 0; seed < 400; ++seed) {
    RandomJsonText random{seed};
    const std::string text = random.blank() + random.value() + random.blank();
    RandomJsonEdits{text, false}.run();
    if (::testing::Test::HasFailure()) {
      ADD_FAILURE() << text;
      return;
    }
  }
}

TEST(JsonEdit, RandomEditsAndTheirInverse) {
  const std::vector<std::string> texts = json_texts();
  ASSERT_GT(texts.size(), 20U);
  for (const std::string& text : texts) {
    RandomJsonEdits{text}.run();
    if (::testing::Test::HasFailure()) {
      ADD_FAILURE() << text.substr(0, 400);
      return;
    }
  }
}

}  // namespace
}  // namespace edsc
