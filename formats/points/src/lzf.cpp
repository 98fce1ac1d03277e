#include "lzf.hpp"

namespace gravure {
namespace {

Error damaged(std::size_t at) {
  return {ErrorCode::bad_file, "the compressed data are damaged at their byte " + std::to_string(at)};
}

}  // namespace

Result<std::string> lzf_unpacked(std::string_view packed, std::size_t size) {
  constexpr std::size_t kMostCopied = 264;  // by 3 bytes: more cannot come out
  if (size / kMostCopied > packed.size()) {
    return Error{ErrorCode::bad_file, std::to_string(size) + " bytes cannot come out of " +
                                          std::to_string(packed.size()) + " compressed ones"};
  }
  std::string out;
  out.reserve(size);
  const auto byte = [&](std::size_t at) { return static_cast<std::size_t>(static_cast<unsigned char>(packed[at])); };
  for (std::size_t at = 0; at < packed.size();) {
    const std::size_t control = byte(at++);
    if (control < 32) {  // a run of control + 1 literal bytes
      const std::size_t run = control + 1;
      if (run > packed.size() - at || run > size - out.size()) {
        return damaged(at);
      }
      out.append(packed.substr(at, run));
      at += run;
      continue;
    }
    std::size_t length = (control >> 5U) + 2;
    if (length == 9) {
      if (at == packed.size()) {
        return damaged(at);
      }
      length += byte(at++);
    }
    if (at == packed.size()) {
      return damaged(at);
    }
    const std::size_t back = ((control & 31U) << 8U) + byte(at++) + 1;
    if (back > out.size() || length > size - out.size()) {
      return damaged(at);
    }
    for (std::size_t i = 0; i < length; ++i) {
      out.push_back(out[out.size() - back]);  // may overlap what it writes
    }
  }
  return out.size() == size ? Result<std::string>(std::move(out)) : damaged(packed.size());
}

}  // namespace gravure
