#include "placed_error.hpp"

namespace gravure::cli {

Error placed_error(const Job& job, std::string_view key, Error error) {
  if (error.code == ErrorCode::cancelled) {
    return error;
  }
  std::string at(key);
  for (const auto& [name, place] : job.places) {
    const std::string last = name.substr(name.find_last_of('.') + 1) + " ";
    const bool begins = error.message.rfind(name + " ", 0) == 0 || error.message.rfind(last, 0) == 0;
    at = begins && name.find('.') != std::string::npos ? name : at;
  }
  error.message = job.place_of(at) + error.message;
  return error;
}

}  // namespace gravure::cli
