#include "gravure/formats/job_keys.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "gravure/formats/job_file.hpp"
#include "markdown_table.hpp"

namespace gravure {
namespace {

using test::cells_of;

std::string document() {
  std::ifstream file(GRAVURE_JOB_DOC, std::ios::binary);
  EXPECT_TRUE(file) << GRAVURE_JOB_DOC;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The rows of the tables whose first column is a section in brackets.
std::vector<JobKey> documented_keys() {
  std::vector<JobKey> keys;
  std::istringstream stream(document());
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("| `[", 0) != 0) {
      continue;
    }
    const std::vector<std::string> cells = cells_of(line);
    EXPECT_EQ(cells.size(), 7U) << line;
    if (cells.size() == 7) {
      EXPECT_FALSE(cells[6].empty()) << line;
      keys.push_back({cells[0].substr(1, cells[0].size() - 2), cells[1], cells[2], cells[3], cells[4], cells[5]});
    }
  }
  return keys;
}

TEST(JobDocument, HasTheReadersKeysAndNoOthers) {
  const std::vector<JobKey> known = job_keys();
  const std::vector<JobKey> documented = documented_keys();
  ASSERT_EQ(documented.size(), known.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    EXPECT_EQ(documented[i].section, known[i].section);
    EXPECT_EQ(documented[i].key, known[i].key);
    EXPECT_EQ(documented[i].type, known[i].type) << known[i].key;
    EXPECT_EQ(documented[i].unit, known[i].unit) << known[i].key;
    EXPECT_EQ(documented[i].range, known[i].range) << known[i].key;
    EXPECT_EQ(documented[i].fallback, known[i].fallback) << known[i].key;
  }
}

TEST(JobDocument, ShowsJobsThatParse) {
  const std::string text = document();
  int examples = 0;
  std::size_t end = 0;
  for (std::size_t at = text.find("```toml\n"); at != std::string::npos; at = text.find("```toml\n", end)) {
    const std::size_t begin = at + 8;
    end = text.find("```", begin);
    ASSERT_NE(end, std::string::npos);
    const Result<Job> result = parse_job(text.substr(begin, end - begin), "example");
    EXPECT_TRUE(result) << result.error().message;
    ++examples;
  }
  EXPECT_GE(examples, 2);
}

}  // namespace
}  // namespace gravure
