#include <gtest/gtest.h>

#include <cstdlib>

#include "stimulus.hpp"

namespace gravure::cosim {
namespace {

std::uint64_t number_from(const char* variable, std::uint64_t fallback) {
  const char* text = std::getenv(variable);
  return text == nullptr ? fallback : std::strtoull(text, nullptr, 10);
}

std::string show(const std::vector<Port>& ports, const std::vector<std::uint64_t>& values) {
  std::string text;
  for (std::size_t at = 0; at < ports.size(); ++at) {
    text += " " + ports[at].name + "=" + std::to_string(values[at]);
  }
  return text;
}

class LockStep : public testing::TestWithParam<std::string> {};

/// GRAVURE_COSIM_CLOCKS clocks of every block, every output on every clock.
TEST_P(LockStep, ModelAndRtlShowTheSameOnEveryClock) {
  const std::uint64_t seed = number_from("GRAVURE_TEST_SEED", 1);
  const std::uint64_t clocks = number_from("GRAVURE_COSIM_CLOCKS", GRAVURE_COSIM_CLOCKS);
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  const auto model = find_block(GetParam())->model();
  const auto rtl = make_rtl(GetParam());
  ASSERT_NE(rtl, nullptr);
  Dice dice(seed);
  const Stimulus stimulus = stimulus_for(*model);
  std::vector<std::uint64_t> in(model->inputs().size());
  std::vector<std::uint64_t> of_model(model->outputs().size());
  std::vector<std::uint64_t> of_rtl(model->outputs().size());
  std::vector<std::uint64_t> first;
  std::vector<bool> moved(model->outputs().size());
  in[0] = 1;  // rst
  model->step(in, of_model);
  rtl->step(in, of_rtl);
  first = of_model;
  for (std::uint64_t clock = 1; clock <= clocks; ++clock) {
    stimulus(dice, in);
    model->step(in, of_model);
    rtl->step(in, of_rtl);
    ASSERT_EQ(of_model, of_rtl) << "clock " << clock << "\ninputs" << show(model->inputs(), in) << "\nmodel"
                                << show(model->outputs(), of_model) << "\nRTL" << show(model->outputs(), of_rtl);
    for (std::size_t at = 0; at < first.size(); ++at) {
      moved[at] = moved[at] || of_model[at] != first[at];
    }
  }
  for (std::size_t at = 0; at < first.size(); ++at) {
    EXPECT_TRUE(moved[at]) << model->outputs()[at].name << " never moved: the stimulus does not reach it";
  }
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const Block& block : all_blocks()) {
    all.push_back(block.name);
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, LockStep, testing::ValuesIn(names()), [](const auto& tested) { return tested.param; });

}  // namespace
}  // namespace gravure::cosim
