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
    top_->clk = 0;
    top_->eval();
  }
  ~RtlMachine() override { top_->final(); }
  RtlMachine(const RtlMachine&) = delete;
  RtlMachine& operator=(const RtlMachine&) = delete;

  const std::vector<Port>& inputs() const override { return inputs_; }
  const std::vector<Port>& outputs() const override { return outputs_; }
  void step(std::span<const std::uint64_t> in, std::span<std::uint64_t> out) override {
    Ports::in(*top_, PortDriver(in));
    top_->clk = 1;
    top_->eval();
    top_->clk = 0;
    top_->eval();
    Ports::out(*top_, PortReader(out));
  }

 private:
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
