#include <verilated.h>

#include "ports.hpp"
#include "rtl_headers.hpp"  // generated: the class of every variant

namespace gravure::cosim {
namespace {

template <class Ports, class Top>
class RtlMachine final : public Machine {
 public:
  RtlMachine() {
    Ports::in(*top_, PortLister(inputs_));
    Ports::out(*top_, PortLister(outputs_));
    set_clocks(0);
  }
  ~RtlMachine() override { top_->final(); }
  RtlMachine(const RtlMachine&) = delete;
  RtlMachine& operator=(const RtlMachine&) = delete;

  const std::vector<Port>& inputs() const override { return inputs_; }
  const std::vector<Port>& outputs() const override { return outputs_; }
  void step(std::span<const std::uint64_t> in, std::span<std::uint64_t> out) override {
    Ports::in(*top_, PortDriver(in));
    set_clocks(1);
    set_clocks(0);
    seed_edge_ = !seed_edge_;
    Ports::out(*top_, PortReader(out));
  }

 private:
  /// A block of two clocks has an edge of `clk` with every second one of `clk_fast`, the first included.
  void set_clocks(std::uint8_t level) {
    if constexpr (requires(Top & top) { top.clk_fast; }) {
      top_->clk_fast = level;
      top_->clk = level != 0 && seed_edge_ ? 1 : 0;
    } else {
      top_->clk = level;
    }
    top_->eval();
  }

  bool seed_edge_ = true;
  VerilatedContext context_;
  std::unique_ptr<Top> top_ = std::make_unique<Top>(&context_);
  std::vector<Port> inputs_;
  std::vector<Port> outputs_;
};

}  // namespace

std::unique_ptr<Machine> make_rtl(const std::string& name) {
#define VARIANT(variant, ...)                                       \
  if (name == #variant) {                                           \
    return std::make_unique<RtlMachine<__VA_ARGS__, V##variant>>(); \
  }
#include "variants.def"
#undef VARIANT
  return nullptr;
}

}  // namespace gravure::cosim
