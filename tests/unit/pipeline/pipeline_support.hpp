#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

#include "dice.hpp"
#include "naive_compile.hpp"

namespace gravure::test {

struct Compiled {
  MemoryProgram program;
  Result<ProgramHeader> result = Error{ErrorCode::bad_argument, "not run"};
};

inline Compiled compile_stack(const ProgramHeader& header, const LayerStack& stack, const MemoryImages& images,
                              std::int64_t lines_per_chunk, const CompileOptions& options = {}) {
  Compiled compiled;
  compiled.program.lines_per_chunk = lines_per_chunk;
  MemorySink sink(compiled.program);
  compiled.result = compile(header, stack, images, sink, options);
  EXPECT_FALSE(sink.put_at_once_by_two);
  return compiled;
}

/// Every line, and the pulses of every layer.
inline void expect_naive(const Compiled& compiled, const ProgramHeader& header, const LayerStack& stack,
                         MemoryImages& images) {
  ASSERT_TRUE(compiled.result) << compiled.result.error().message;
  ASSERT_EQ(compiled.program.finished, 1);
  for (std::size_t layer = 0; layer < stack.layers.size(); ++layer) {
    std::int64_t fired = 0;
    for (std::int64_t line = 0; line < stack.lines; ++line) {
      const auto expected = naive_line(header, stack, images, static_cast<std::int64_t>(layer), line);
      ASSERT_EQ(compiled.program.line(static_cast<std::int64_t>(layer), line), expected)
          << "layer " << layer << ", line " << line;
      for (const std::byte byte : expected) {
        fired += std::popcount(std::to_integer<unsigned>(byte));
      }
    }
    EXPECT_EQ(compiled.program.header.layers[layer].fired_pixels, fired) << "layer " << layer;
    EXPECT_EQ(compiled.result.value().layers[layer].fired_pixels, fired);
  }
}

/// No folder for temporary files, as long as it lives.
class NoTemporaryFolder {
 public:
  NoTemporaryFolder() {
    if (const char* before = std::getenv("TMPDIR")) {
      kept_ = before;
    }
    EXPECT_EQ(::setenv("TMPDIR", "/nonexistent", 1), 0);
  }
  NoTemporaryFolder(const NoTemporaryFolder&) = delete;
  NoTemporaryFolder& operator=(const NoTemporaryFolder&) = delete;
  ~NoTemporaryFolder() { EXPECT_EQ(kept_ ? ::setenv("TMPDIR", kept_->c_str(), 1) : ::unsetenv("TMPDIR"), 0); }

 private:
  std::optional<std::string> kept_;
};

}  // namespace gravure::test
