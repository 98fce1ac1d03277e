#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace gravure::protocol {

/// The bytes that docs/protocol.md works out behind "name:", to the line that names the next ones.
inline std::vector<std::byte> worked_bytes(const std::string& name) {
  std::ifstream page(GRAVURE_PROTOCOL_DOC);
  std::vector<std::byte> bytes;
  bool ours = false;
  for (std::string line; std::getline(page, line);) {
    const std::size_t colon = line.find(':');
    if (colon != std::string::npos || line == "```") {
      ours = line.substr(0, colon) == name;
      line = ours ? line.substr(colon + 1) : "";
    }
    std::istringstream digits(ours ? line : "");
    for (std::string byte; digits >> byte;) {
      bytes.push_back(static_cast<std::byte>(std::stoul(byte, nullptr, 16)));
    }
  }
  EXPECT_FALSE(bytes.empty()) << "docs/protocol.md has no " << name;
  return bytes;
}

}  // namespace gravure::protocol
