#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace gravure {

/// What kind of failure. Each has one exit status (exit_status()) and one line in docs/errors.md; a test keeps them
/// equal.
enum class ErrorCode : std::uint8_t {
  bad_argument,      ///< a job, option or call that contradicts itself or what is possible
  out_of_range,      ///< a value outside its stated range
  bad_file,          ///< an input file that is damaged, of the wrong kind, or does not fit the job
  io,                ///< the operating system refused to read or write
  device,            ///< the device refused, faulted or answered nonsense
  timeout,           ///< no answer within the stated time
  version_mismatch,  ///< file, board or module of another version
  cancelled,         ///< stopped on request
};

inline constexpr ErrorCode kAllErrorCodes[] = {
    ErrorCode::bad_argument, ErrorCode::out_of_range, ErrorCode::bad_file,         ErrorCode::io,
    ErrorCode::device,       ErrorCode::timeout,      ErrorCode::version_mismatch, ErrorCode::cancelled};

/// The code's name as it stands in `--json` and docs/errors.md, for example "bad_file".
std::string_view error_code_name(ErrorCode code) noexcept;

/// The exit status main() gives for it: 2 input, 3 device or I/O, 4 interrupted.
int exit_status(ErrorCode code) noexcept;

/// Why a call failed. `message` reaches the operator as it is: where, field, value, allowed, what to do.
/// Several violations of one input are lines of one message, each said once.
struct Error {
  ErrorCode code;
  std::string message;
};

/// A T or an Error. (std::expected is C++23.) Reading the wrong one throws std::bad_variant_access: a caller's bug.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  explicit operator bool() const noexcept { return state_.index() == 0; }
  const T& value() const& { return std::get<0>(state_); }
  T& value() & { return std::get<0>(state_); }
  T&& value() && { return std::get<0>(std::move(state_)); }
  const Error& error() const& { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

/// Success or an Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : state_(std::move(error)) {}

  explicit operator bool() const noexcept { return state_.index() == 0; }
  const Error& error() const& { return std::get<1>(state_); }

 private:
  std::variant<std::monostate, Error> state_;
};

}  // namespace gravure

/// Leaves the calling function with the error of `expression`, if it holds one.
#define GRAVURE_CHECK(expression)                                \
  do {                                                           \
    if (auto gravure_checked = (expression); !gravure_checked) { \
      return gravure_checked.error();                            \
    }                                                            \
  } while (false)

#define GRAVURE_CONCAT_(a, b) a##b
#define GRAVURE_CONCAT(a, b) GRAVURE_CONCAT_(a, b)
#define GRAVURE_TRY_(result, declaration, expression) \
  auto result = (expression);                         \
  if (!result) {                                      \
    return result.error();                            \
  }                                                   \
  declaration = std::move(result).value()

/// `GRAVURE_TRY(auto plan, make_plan(job));` declares plan, or leaves the calling function with the error.
#define GRAVURE_TRY(declaration, expression) \
  GRAVURE_TRY_(GRAVURE_CONCAT(gravure_result_, __LINE__), declaration, expression)
