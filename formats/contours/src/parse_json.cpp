#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "contour_list.hpp"

namespace gravure::formats::contour_file {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostDepth = 64;
constexpr std::size_t kMostNotes = 20;

std::string shown(const std::string& text) {
  constexpr std::size_t kMost = 40;
  std::string plain = text.substr(0, kMost);
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F; }, '?');
  return plain;
}

/// Takes the parser's events one by one: nothing of the file is held but the contours themselves.
class Handler final : public nlohmann::json_sax<Json> {
 public:
  explicit Handler(std::string_view text) : text_(text) {}

  Result<ContourFile> finish() && {
    if (error_) {
      return *error_;
    }
    if (!has_contours_) {
      return Error{ErrorCode::bad_file, R"(the key "contours" is missing)"};
    }
    return std::move(list_).finish();
  }

  bool null() override { return other("null"); }
  bool boolean(bool) override { return other("a boolean"); }
  bool string(string_t&) override { return other("a string"); }
  bool binary(binary_t&) override { return other("binary data"); }
  bool number_integer(number_integer_t value) override { return number(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return number(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }

  bool start_object(std::size_t) override {
    if (levels_.empty()) {
      return enter(Level::root);
    }
    if (levels_.back() == Level::contours) {
      has_points_ = has_direction_ = false;
      has_own_id_ = false;
      return enter(Level::contour);
    }
    return skip_inside("an object");
  }

  bool key(string_t& name) override {
    key_ = name;
    if (levels_.back() == Level::root) {
      if (name == "contours") {
        return std::exchange(has_contours_, true) ? fail("the key \"contours\" is there twice") : true;
      }
      return unknown_key(name);
    }
    if (levels_.back() == Level::contour) {
      bool* const seen = name == "id"          ? &has_own_id_
                         : name == "points"    ? &has_points_
                         : name == "direction" ? &has_direction_
                                               : nullptr;
      if (seen == nullptr) {
        return unknown_key(name);
      }
      return std::exchange(*seen, true) ? fail(list_.where() + ": the key \"" + name + "\" is there twice") : true;
    }
    return true;
  }

  bool end_object() override {
    const Level level = leave();
    if (level != Level::contour) {
      return true;
    }
    const char* const missing = !has_own_id_ ? "id" : !has_points_ ? "points" : !has_direction_ ? "direction" : nullptr;
    if (missing != nullptr) {
      return fail(fmt::format("{}: the key \"{}\" is missing", list_.where(), missing));
    }
    return hold(list_.end_contour());
  }

  bool start_array(std::size_t) override {
    if (!levels_.empty() && levels_.back() == Level::root && key_ == "contours") {
      return enter(Level::contours);
    }
    if (!levels_.empty() && levels_.back() == Level::contour && key_ == "points") {
      return enter(Level::points);
    }
    if (!levels_.empty() &&
        ((levels_.back() == Level::contour && key_ == "direction") || levels_.back() == Level::points)) {
      taken_ = 0;
      return enter(levels_.back() == Level::points ? Level::point : Level::direction);
    }
    return skip_inside("a list");
  }

  bool end_array() override {
    const Level level = leave();
    if (level != Level::point && level != Level::direction) {
      return true;
    }
    if (taken_ != vector_.size()) {
      return fail(fmt::format("{}: {} has {} number{}: must have three", list_.where(), vector_name(level), taken_,
                              taken_ == 1 ? "" : "s"));
    }
    return hold(level == Level::point ? list_.add_point(vector_) : list_.set_direction(vector_));
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    const std::size_t at = std::min(position > 0 ? position - 1 : 0, text_.size());
    const std::string_view before = text_.substr(0, at);
    const std::size_t start = before.rfind('\n');
    // 406: a number too large for a double.
    error_ = Error{ErrorCode::bad_file,
                   fmt::format("{}:{}: {}", 1 + std::count(before.begin(), before.end(), '\n'),
                               at - (start == std::string_view::npos ? 0 : start + 1) + 1,
                               error.id == 406 ? "a number is beyond what a double holds" : "this is no JSON")};
    return false;
  }

 private:
  enum class Level : std::uint8_t { root, contours, contour, points, point, direction, unknown };

  bool fail(std::string message, ErrorCode code = ErrorCode::bad_file) {
    error_ = Error{code, std::move(message)};
    return false;
  }
  bool hold(const Result<void>& result) {
    if (!result) {
      error_ = result.error();
    }
    return static_cast<bool>(result);
  }
  bool enter(Level level) {
    levels_.push_back(level);
    return true;
  }
  Level leave() {
    const Level level = levels_.back();
    levels_.pop_back();
    return level;
  }

  std::string vector_name(Level level) {
    return level == Level::direction ? "direction" : fmt::format("points[{}]", list_.current().points_mm.size());
  }

  bool unknown_key(const std::string& name) {
    if (unknown_.size() < kMostNotes && unknown_.insert(name).second) {
      list_.note(fmt::format("the key \"{}\" is not known and is passed over", shown(name)));
    }
    return true;
  }

  /// The value of an unknown key?
  bool is_unknown() const {
    if (levels_.empty()) {
      return false;
    }
    const Level level = levels_.back();
    return level == Level::unknown || (level == Level::root && key_ != "contours") ||
           (level == Level::contour && key_ != "id" && key_ != "points" && key_ != "direction");
  }

  bool skip_inside(const char* what) {
    if (!is_unknown()) {
      return misplaced(what);
    }
    return levels_.size() < kMostDepth ? enter(Level::unknown)
                                       : fail(fmt::format("lists and objects nest deeper than {}", kMostDepth));
  }

  bool other(const char* what) { return is_unknown() || misplaced(what); }

  bool misplaced(const char* what) {
    if (levels_.empty()) {
      return fail(fmt::format(R"(is {}: must be an object, {{"contours": [...]}})", what));
    }
    switch (levels_.back()) {
      case Level::root:
        return fail(fmt::format("\"contours\" is {}: must be a list of contours", what));
      case Level::contours:
        return fail(fmt::format("{} is {}: must be an object with id, points and direction", list_.where(), what));
      case Level::points:
        return fail(fmt::format("{}: {} is {}: must be a list of three numbers", list_.where(),
                                vector_name(Level::point), what));
      case Level::point:
      case Level::direction:
        return fail(fmt::format("{}: {} holds {}: must be three numbers (JSON has no NaN)", list_.where(),
                                vector_name(levels_.back()), what));
      default:
        return fail(fmt::format("{}: \"{}\" is {}: must be {}", list_.where(), key_, what,
                                key_ == "id" ? "an integer" : "a list"));
    }
  }

  bool number(double value) {
    if (is_unknown()) {
      return true;
    }
    if (!levels_.empty() && (levels_.back() == Level::point || levels_.back() == Level::direction)) {
      if (taken_ < vector_.size()) {
        vector_[taken_] = value;
      }
      ++taken_;
      return true;
    }
    if (!levels_.empty() && levels_.back() == Level::contour && key_ == "id") {
      return hold(list_.set_id(value));
    }
    return misplaced("a number");
  }

  std::string_view text_;
  ContourList list_;
  std::vector<Level> levels_;
  std::string key_;
  bool has_contours_ = false;
  bool has_own_id_ = false;
  bool has_points_ = false;
  bool has_direction_ = false;
  std::array<double, 3> vector_{};
  std::size_t taken_ = 0;
  std::set<std::string> unknown_;
  std::optional<Error> error_;
};

}  // namespace

Result<ContourFile> parse_json(std::string_view text) {
  Handler handler(text);
  // The result is in the handler: it knows more than "no".
  static_cast<void>(Json::sax_parse(text.begin(), text.end(), &handler));
  return std::move(handler).finish();
}

}  // namespace gravure::formats::contour_file
